#pragma once

#include <alluvium/fluid/fluid_checkpoint.h>
#include <alluvium/mesh/partition.h>
#include <alluvium/utilities/checked_file.h>

#include <mpi.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <string>
#include <vector>

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
   * A run's state in a folder of its own: all that its next steps depend on, preconditioner, contact search and
   * partition included. On as many ranks as before a run goes on from it with the same bits, as if nothing had
   * happened; on others with other round-off. Whenever the machine stops there is a whole checkpoint: the new one or
   * the one before. All functions are collective; what is missing or damaged is a UserError.
   */
  class Checkpoint
  {
  public:
    /** Write @p model and @p output to @p folder; neither changes. */
    static void write(const std::string &folder, Model &model, const Output &output);

    /** The same, with what @p save_output puts into the state, on the first rank, in the place of an output's. */
    static void
    write(const std::string &folder, Model &model, const std::function<void(nlohmann::ordered_json &)> &save_output);

    /** The checkpoint that write() left in @p folder. */
    Checkpoint(MPI_Comm communicator, const std::string &folder);

    /**
     * Compare the parameters with those of the interrupted run. Throws UserError if one has changed that is fixed for
     * the whole run. Returns what has changed else, a line for each.
     */
    std::vector<std::string> compare_parameters(const Model &model) const;

    /** In words, where the run goes on from. */
    std::string description(const Model &model) const;

    /** Grains, contacts, time and counts. */
    void load_grains(Model &model);

    /** Who owned which cell, if there were as many ranks as now, else nullptr. After load_grains(). */
    const mesh::Partition *partition() const;

    /** Refine @p mesh, which is the unrefined one, as it was. */
    void load_mesh(dealii::Triangulation<2, 2> &mesh);

    /** The fluid's fields, into a model that has the mesh. */
    void load_fields(Model &model) const;

    /** What solver and coupling have kept from earlier steps, into a model that has fields and partition. */
    void load_history(Model &model);

    /** Its file `state`, with what the caller of write() has put there. */
    const nlohmann::ordered_json &saved_state() const { return state; }

    /** What output and observers remember. */
    void resume(Output &output) const;

  private:
    template <typename Action>
    void read(const Action &action) const;

    /** Of the interrupted run, by their whole names. */
    std::map<std::string, std::string> parameters() const;

    std::string               folder;
    nlohmann::ordered_json    state;
    std::string               history_bytes;
    ByteReader                history;
    mesh::Partition           cells;
    bool                      as_many_ranks = false;
    fluid::FluidCheckpoint<2> fluid;
  };
} // namespace alluvium::run
