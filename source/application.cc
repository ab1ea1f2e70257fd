#include <alluvium/application.h>
#include <alluvium/scene/accuracy.h>
#include <alluvium/scene/declared_parameters.h>
#include <alluvium/scene/parameter_file.h>
#include <alluvium/scene/shared_libraries.h>
#include <alluvium/simulation.h>
#include <alluvium/utilities/failure.h>
#include <alluvium/utilities/log.h>
#include <alluvium/utilities/mpi_environment.h>
#include <alluvium/utilities/signals.h>
#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/version.h>

#include <deal.II/base/config.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <boost/program_options.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

namespace alluvium
{
  namespace
  {
    namespace options = boost::program_options;

    struct CommandLine
    {
      std::string              scene;
      std::vector<std::string> assignments;
      bool                     check = false, print_parameters = false, version = false, help = false;
    };

    options::options_description described_options()
    {
      options::options_description description("Options", 100);
      description.add_options()(
        "check",
        "read the scene, build it, report what it is, and stop; finds what a run would find before its first step, and "
        "writes nothing") //
        ("print-parameters",
         "print all parameters with explanation, unit, default and allowed values as a parameter file (with the "
         "values of the scene, if one is given) and stop") //
        ("set",
         options::value<std::vector<std::string>>()->value_name("'Section/Name=value'"),
         "set a parameter, overriding the scene; may be repeated") //
        ("version", "print the versions of the program and its libraries and stop")("help,h", "print this and stop");
      return description;
    }

    CommandLine read_command_line(const int argc, char **argv)
    {
      options::options_description all = described_options();
      all.add_options()("scene", options::value<std::vector<std::string>>(), "");
      options::positional_options_description positional;
      positional.add("scene", -1);

      options::variables_map values;
      try
        {
          // No guessing: an abbreviated option would change its meaning with the next option that is added.
          namespace style = options::command_line_style;
          options::store(options::command_line_parser(argc, argv)
                           .options(all)
                           .positional(positional)
                           .style(style::unix_style & ~style::allow_guessing)
                           .run(),
                         values);
        }
      catch (const options::error &error)
        {
          throw UserError(std::string(error.what()) + "; see alluvium --help.");
        }

      CommandLine result;
      result.check            = values.count("check") > 0;
      result.print_parameters = values.count("print-parameters") > 0;
      result.version          = values.count("version") > 0;
      result.help             = values.count("help") > 0;
      if (values.count("set") > 0)
        result.assignments = values["set"].as<std::vector<std::string>>();
      if (values.count("scene") > 0)
        {
          const auto scenes = values["scene"].as<std::vector<std::string>>();
          check_user(scenes.size() == 1,
                     "one scene at a time, but there are '" + scenes[0] + "' and '" + scenes[scenes.size() - 1] + "'.");
          result.scene = scenes[0];
        }
      check_user(!result.scene.empty() || result.print_parameters || result.version || result.help,
                 "no scene given: alluvium scene.prm; see alluvium --help.");
      return result;
    }

    void print_help(std::ostream &out)
    {
      out
        << "alluvium: grains and the fluid between them (FEM-DEM for immersed granular flows)\n\n"
           "  alluvium [options] scene.prm\n"
           "  mpirun -np N alluvium [options] scene.prm\n\n"
        << described_options()
        << "\nA SIGINT (Ctrl-C), SIGTERM or SIGUSR1 ends a run after its present step, with a checkpoint; a second one "
           "at once,\nas does the first during the set-up.\n\nExit codes: 0 the run has finished or a signal has ended "
           "it; 1 a mistake in the scene or the "
           "command line, or files\nthat cannot be read or written; 2 the linear solver gave up, or a mistake of the "
           "program; 3 the computation has\ndiverged. All but those before the first step leave summary.json, which "
           "says why, and a checkpoint of the last good step.\n";
    }

    void print_version(std::ostream &out)
    {
      char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
      int  length = 0;
      MPI_Get_library_version(mpi, &length);
      const std::string mpi_version(mpi, length);

      out << "alluvium " << version() << '\n'
          << "deal.II  " << DEAL_II_PACKAGE_VERSION << '\n'
          << "Trilinos " << DEAL_II_TRILINOS_VERSION_MAJOR << '.' << DEAL_II_TRILINOS_VERSION_MINOR << '.'
          << DEAL_II_TRILINOS_VERSION_SUBMINOR << '\n'
          << "p4est    " << DEAL_II_P4EST_VERSION_MAJOR << '.' << DEAL_II_P4EST_VERSION_MINOR << '.'
          << DEAL_II_P4EST_VERSION_SUBMINOR << '\n'
          << "MPI      " << mpi_version.substr(0, mpi_version.find_first_of(",\n")) << '\n';
    }

    void run(const CommandLine &command_line, const bool is_first_rank)
    {
      if (command_line.help || command_line.version)
        {
          if (is_first_rank)
            command_line.help ? print_help(std::cout) : print_version(std::cout);
          return;
        }

      const std::string libraries = scene::load_shared_libraries(command_line.scene, command_line.assignments);

      Simulation               simulation(MPI_COMM_WORLD);
      dealii::ParameterHandler prm;
      scene::declare_method(prm);
      scene::declare_accuracy(prm);
      scene::declare_shared_libraries(prm);
      simulation.add_parameters(prm);
      const auto remarks =
        scene::read_parameters(prm, command_line.scene, command_line.assignments, Simulation::paper_method());
      simulation.describe_accuracy(remarks.choices);
      if (is_first_rank)
        for (const std::string &warning : remarks.warnings)
          std::cerr << "alluvium: warning: " << warning << std::endl;
      scene::set_shared_libraries(prm, libraries);

      if (command_line.print_parameters)
        {
          if (is_first_rank)
            scene::DeclaredParameters(prm).print(std::cout);
          return;
        }

      std::string directory = std::filesystem::path(command_line.scene).parent_path().string();
      if (directory.empty())
        directory = ".";
      if (command_line.check)
        simulation.check(prm, directory);
      else
        simulation.run(prm, directory);
    }

    /**
     * End all ranks together. If all of them come here, the first that failed prints and all return. If some failed
     * alone, the others are waiting for them in some communication that will never come: speak and abort.
     */
    int finish(MPI_Comm communicator, const int exit_code, const std::string &message)
    {
      int rank = 0, n_ranks = 1;
      MPI_Comm_rank(communicator, &rank);
      MPI_Comm_size(communicator, &n_ranks);
      const auto print = [&] { std::cerr << "alluvium: error: " << message << std::endl; };

      int         speaker = exit_code != 0 ? rank : n_ranks, first = n_ranks;
      MPI_Request request;
      MPI_Iallreduce(&speaker, &first, 1, MPI_INT, MPI_MIN, communicator, &request);
      if (exit_code == 0)
        MPI_Wait(&request, MPI_STATUS_IGNORE);
      else
        {
          // Ranks give up one after the other, so that one of them prints and not all that failed.
          const auto deadline =
            std::chrono::steady_clock::now() + std::chrono::milliseconds(3000 + 500 * std::min(rank, 60));
          int done = 0;
          while (true)
            {
              MPI_Test(&request, &done, MPI_STATUS_IGNORE);
              if (done != 0)
                break;
              if (std::chrono::steady_clock::now() > deadline)
                {
                  print();
                  MPI_Abort(MPI_COMM_WORLD, exit_code);
                }
              std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
      if (first == rank)
        print();

      int code = exit_code, common_code = 0;
      MPI_Allreduce(&code, &common_code, 1, MPI_INT, MPI_MAX, communicator);
      return common_code;
    }
  } // namespace


  int run_application(int argc, char **argv)
  {
    // Not our arguments: PETSc, which deal.II starts too, would take some for its own and complain about the others.
    int    mpi_argc = 1;
    char  *name[]   = {argv[0], nullptr};
    char **mpi_argv = name;

    ignore_file_limit_signal();
    const MpiEnvironment mpi(mpi_argc, mpi_argv);
    const bool           is_first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;

    const Log log(!is_first_rank);

    // A communicator of its own: what finish() sends must not meet what a failed step has left behind.
    MPI_Comm communicator;
    MPI_Comm_dup(MPI_COMM_WORLD, &communicator);

    int         exit_code = 0;
    std::string message;
    try
      {
        run(read_command_line(argc, argv), is_first_rank);
      }
    catch (...)
      {
        const Failure failure = describe_failure(std::current_exception());
        exit_code             = failure.exit_code;
        message               = failure.message;
      }
    std::cout.flush();
    exit_code = finish(communicator, exit_code, message);
    MPI_Comm_free(&communicator);
    return exit_code;
  }
} // namespace alluvium
