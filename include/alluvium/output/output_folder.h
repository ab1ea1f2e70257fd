#pragma once

#include <mpi.h>

#include <memory>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium
{
  class FolderLock;
}

namespace alluvium::output
{
  /**
   * The folder that a run writes to. It never takes away an older run's results unless it is told to, and never those
   * of one that goes on: the folder is locked while the run lives.
   */
  class OutputFolder
  {
  public:
    OutputFolder();
    ~OutputFolder();

    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Throws what create() would, as far as can be seen, and changes nothing. An older run in the folder may be only
     * remarked on, in what is returned: empty if there is nothing to say. Collective.
     */
    std::string check(MPI_Comm communicator, bool is_restart, bool may_hold_a_run);

    /**
     * Check that the folder can be used, lock it and make it if need be; a UserError on every rank, and nothing changed
     * on the disk, if it cannot. A restart wants the folder of the older run and keeps what is in it. Collective; to be
     * called when the scene has been built, so that a mistake in it leaves no folder behind.
     */
    void create(MPI_Comm communicator, bool is_restart = false);

    const std::string &path() const { return folder; }

    /** The path of a file in it. */
    std::string file(const std::string &name) const { return folder + "/" + name; }

  private:
    void        trim_name();
    bool        check_on_this_rank(bool is_restart) const; // whether it exists
    void        create_on_this_rank(bool is_restart);
    std::string quoted() const;
    std::string older_run() const;
    std::string in_use(const std::string &holder) const;

    std::string                 folder        = "output";
    bool                        may_overwrite = false;
    std::unique_ptr<FolderLock> lock;
  };
} // namespace alluvium::output
