#include <alluvium/output/output_folder.h>
#include <alluvium/utilities/first_rank.h>
#include <alluvium/utilities/folder_lock.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

namespace alluvium::output
{
  namespace fs = std::filesystem;

  namespace
  {
    bool holds_a_run(const fs::path &folder)
    {
      return fs::exists(folder / "statistics.csv") || fs::exists(folder / "parameters.prm");
    }

    /** Throws @p complaint with the reason unless files can be made in @p folder. */
    void check_writable(const fs::path &folder, const std::string &complaint)
    {
      if (access(folder.c_str(), W_OK | X_OK) == 0)
        return;
      const int reason = errno;
      throw UserError(complaint + std::strerror(reason) + ".");
    }

    /** Is it a folder of this program's files alone, however far it came with them? */
    bool holds_a_checkpoint_only(const fs::directory_entry &entry)
    {
      if (!entry.is_directory())
        return false;
      for (const auto &file : fs::directory_iterator(entry))
        {
          fs::path path = file.path().filename();
          if (path.extension() == ".tmp")
            path = path.stem();
          const std::string name = path.string();
          if (!file.is_regular_file() || !(name == "state" || name == "history" || name == "solver" ||
                                           name == "grains" || name.compare(0, 5, "fluid") == 0))
            return false;
        }
      return true;
    }

    /** What a run writes, and nothing else that somebody may have put beside it. */
    bool is_of_a_run(const fs::directory_entry &entry)
    {
      fs::path path = entry.path().filename();
      if (path.extension() == ".tmp") // what was being written when a run was killed
        path = path.stem();
      const std::string name = path.string(), extension = path.extension().string();
      if (name.compare(0, 10, "checkpoint") == 0) // a folder; one left over would be what a restart starts from
        return holds_a_checkpoint_only(entry);
      if (!entry.is_regular_file())
        return false;
      for (const std::string ours : {".vtu", ".pvtu", ".pvd", ".vtp", ".h5", ".xdmf"})
        if (extension == ours)
          return true;
      return name == "statistics.csv" || name == "summary.json" || name == "parameters.prm" || name == "log.txt";
    }

    /** What has a checkpoint's name in @p folder and is none, or empty. */
    std::string foreign_checkpoint_in(const fs::path &folder)
    {
      for (const auto &entry : fs::directory_iterator(folder))
        if (const std::string name = entry.path().filename().string();
            name.compare(0, 10, "checkpoint") == 0 && !holds_a_checkpoint_only(entry))
          return name;
      return "";
    }

    /** What this run has read in @p folder and would replace, whatever way its path was written; or empty. */
    std::string input_in(const fs::path &folder)
    {
      std::error_code ignored;
      for (const auto &entry : fs::directory_iterator(folder))
        if (is_of_a_run(entry))
          for (const InputFile &input : noted_inputs())
            if (fs::equivalent(entry.path(), input.path, ignored))
              return entry.path().filename().string();
      return "";
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

  OutputFolder::OutputFolder()  = default;
  OutputFolder::~OutputFolder() = default;


  std::string OutputFolder::check(MPI_Comm communicator, const bool is_restart, const bool may_hold_a_run)
  {
    trim_name();
    std::string remark;
    on_first_rank(communicator, [&] {
      const bool exists = check_on_this_rank(is_restart);
      if (exists && !is_restart && !may_overwrite && holds_a_run(folder))
        {
          check_user(may_hold_a_run, older_run());
          remark = older_run();
        }
    });
    return dealii::Utilities::MPI::broadcast(communicator, remark, 0);
  }


  void OutputFolder::create(MPI_Comm communicator, const bool is_restart)
  {
    trim_name();
    // rank 0 decides for all: another would take the folder that it has just made for an older run's
    on_first_rank(communicator, [&] { create_on_this_rank(is_restart); });
  }


  void OutputFolder::trim_name()
  {
    while (folder.size() > 1 && folder.back() == '/')
      folder.pop_back();
  }


  std::string OutputFolder::quoted() const
  {
    return "output folder '" + folder + "'";
  }


  std::string OutputFolder::older_run() const
  {
    return "the " + quoted() +
           " holds an older run; name another one, or set 'Overwrite output folder = true' to replace it.";
  }


  bool OutputFolder::check_on_this_rank(const bool is_restart) const
  {
    check_user(!folder.empty(), "the output folder needs a name.");
    std::error_code error;
    const bool      exists = fs::exists(folder, error);
    check_user(!error, "cannot look at the " + quoted() + ": " + error.message() + ".");
    check_user(!exists || fs::is_directory(folder), "the " + quoted() + " is a file.");
    check_user(!is_restart || exists, "there is no " + quoted() + " to restart from.");
    if (!exists)
      {
        const fs::path    parent = fs::absolute(folder).parent_path();
        const std::string cannot = "the " + quoted() + " cannot be made: ";
        check_user(fs::is_directory(parent), cannot + "there is no folder '" + parent.string() + "' to make it in.");
        check_writable(parent, cannot);
        return false;
      }
    check_writable(folder, "the " + quoted() + " cannot be written to: ");
    const std::string holder = lock ? "" : FolderLock::holder_of(folder);
    check_user(holder.empty(), in_use(holder));
    if (!is_restart && (may_overwrite || !holds_a_run(folder)))
      {
        const std::string input = input_in(folder);
        check_user(input.empty(),
                   "the " + quoted() + " holds '" + input +
                     "', which this run reads and would replace: name another output folder.");
        const std::string foreign = foreign_checkpoint_in(folder);
        check_user(foreign.empty(),
                   "the " + quoted() + " holds '" + foreign +
                     "', which no run has written, and checkpoints would take its place: name another output folder.");
      }
    return true;
  }


  std::string OutputFolder::in_use(const std::string &holder) const
  {
    return "the " + quoted() + " is in use by another run (" + holder +
           "): name another one, or wait until that has ended.";
  }


  void OutputFolder::create_on_this_rank(const bool is_restart)
  {
    if (!check_on_this_rank(is_restart))
      {
        std::error_code error;
        fs::create_directory(folder, error);
        check_user(!error, "the " + quoted() + " cannot be made: " + error.message() + ".");
      }
    if (!lock)
      {
        auto mine = std::make_unique<FolderLock>(folder);
        check_user(!mine->is_taken(), in_use(mine->holder_in_words()));
        lock = std::move(mine);
      }
    if (is_restart || !holds_a_run(folder))
      return;
    check_user(may_overwrite, older_run());
    std::vector<fs::path> old;
    for (const auto &entry : fs::directory_iterator(folder))
      if (is_of_a_run(entry))
        old.push_back(entry.path());
    for (const auto &file : old)
      fs::remove_all(file);
  }
} // namespace alluvium::output
