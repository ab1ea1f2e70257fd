#include <alluvium/observers/output_folder.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

namespace alluvium::observers
{
  namespace fs = std::filesystem;

  namespace
  {
    bool holds_a_run(const fs::path &folder)
    {
      return fs::exists(folder / "statistics.csv") || fs::exists(folder / "parameters.prm");
    }

    /** What a run writes, and nothing else that somebody may have put beside it. */
    bool is_of_a_run(const fs::directory_entry &entry)
    {
      const std::string name = entry.path().filename().string(), extension = entry.path().extension().string();
      if (name.compare(0, 10, "checkpoint") == 0) // a folder; one left over would be what a restart starts from
        return true;
      if (!entry.is_regular_file())
        return false;
      for (const std::string ours : {".vtu", ".pvtu", ".pvd", ".csv", ".h5", ".xdmf"})
        if (extension == ours)
          return true;
      return name == "summary.json" || name == "parameters.prm" || name == "log.txt";
    }
  } // namespace

  void OutputFolder::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Output folder",
                      folder,
                      "Where the run writes; made if it does not exist (the folder around it must). Relative to where "
                      "the program is started.",
                      dealii::Patterns::DirectoryName());
    prm.add_parameter("Overwrite output folder",
                      may_overwrite,
                      "Whether a folder that holds an older run may be used; that run's files are then removed.");
  }

  void OutputFolder::create(MPI_Comm communicator, const bool is_restart)
  {
    while (folder.size() > 1 && folder.back() == '/')
      folder.pop_back();

    // Rank 0 decides for all: otherwise one rank would take the folder that another one has just made for an older
    // run's.
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          create_on_this_rank(is_restart);
        }
      catch (const std::exception &error)
        {
          problem = error.what();
        }
    problem = dealii::Utilities::MPI::broadcast(communicator, problem, 0);
    check_user(problem.empty(), problem);
  }

  void OutputFolder::create_on_this_rank(const bool is_restart) const
  {
    const std::string quoted = "output folder '" + folder + "'";
    check_user(!folder.empty(), "the output folder needs a name.");
    std::error_code error;
    const bool      exists = fs::exists(folder, error);
    check_user(!error, "cannot look at the " + quoted + ": " + error.message() + ".");
    check_user(!exists || fs::is_directory(folder), "the " + quoted + " is a file.");
    check_user(!is_restart || exists, "there is no " + quoted + " to restart from.");

    if (!exists)
      {
        const fs::path parent = fs::absolute(folder).parent_path();
        check_user(fs::is_directory(parent),
                   "the " + quoted + " cannot be made: there is no folder '" + parent.string() + "' to make it in.");
        fs::create_directory(folder, error);
        check_user(!error, "the " + quoted + " cannot be made: " + error.message() + ".");
        return;
      }

    check_user(access(folder.c_str(), W_OK | X_OK) == 0,
               "the " + quoted + " cannot be written to: " + std::strerror(errno) + ".");
    if (is_restart || !holds_a_run(folder))
      return;
    check_user(may_overwrite,
               "the " + quoted +
                 " holds an older run; name another one, or set 'Overwrite output folder = true' to replace it.");
    std::vector<fs::path> old;
    for (const auto &entry : fs::directory_iterator(folder))
      if (is_of_a_run(entry))
        old.push_back(entry.path());
    for (const auto &file : old)
      fs::remove_all(file);
  }
} // namespace alluvium::observers
