#pragma once

#include <mpi.h>

#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::observers
{
  /** The folder that a run writes to. It never takes away an older run's results unless it is told to. */
  class OutputFolder
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Check that the folder can be used and make it if need be; a UserError on every rank, and nothing changed on the
     * disk, if it cannot. A restart wants the folder of the older run and keeps what is in it. Collective; to be called
     * when the scene has been built, so that a mistake in it leaves no folder behind.
     */
    void create(MPI_Comm communicator, bool is_restart = false);

    const std::string &path() const { return folder; }

    /** The path of a file in it. */
    std::string file(const std::string &name) const { return folder + "/" + name; }

  private:
    void create_on_this_rank(bool is_restart) const;

    std::string folder        = "output";
    bool        may_overwrite = false;
  };
} // namespace alluvium::observers
