#pragma once

#include <alluvium/mesh/fluid_checkpoint.h>

#include <mpi.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace dealii
{
  template <int, int>
  class Triangulation;
}

namespace alluvium::run
{
  struct Model;
  class Output;

  /**
   * A run's state in a folder of its own, to go on from with the same bits on any number of ranks. Whenever the machine
   * stops there is a whole checkpoint: the new one or the one before. All functions are collective; what is missing or
   * damaged is a UserError.
   */
  class Checkpoint
  {
  public:
    /** Write @p model and @p output to @p folder. The run goes on as a restarted one would. */
    static void write(const std::string &folder, Model &model, const Output &output);

    /** The same, with what @p save_output puts into the state, on the rank that speaks, in the place of an output's. */
    static void
    write(const std::string &folder, Model &model, const std::function<void(nlohmann::ordered_json &)> &save_output);

    /** The checkpoint that write() left in @p folder. */
    Checkpoint(MPI_Comm communicator, const std::string &folder);

    /** Grains, contacts, time and counts, into a model that has the scene's grains. */
    void load_grains(Model &model) const;

    /** Refine @p mesh, which is the unrefined one, as it was. */
    void load_mesh(dealii::Triangulation<2, 2> &mesh);

    /** The fluid's fields, into a model that has the mesh. */
    void load_fields(Model &model) const;

    /** What output and observers remember. */
    void resume(Output &output) const;

  private:
    template <typename Action>
    void read(const Action &action) const;

    std::string              folder;
    nlohmann::ordered_json   state;
    mesh::FluidCheckpoint<2> fluid;
  };
} // namespace alluvium::run
