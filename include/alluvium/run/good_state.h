#pragma once

#include <alluvium/contacts/search/contact_archive.h>
#include <alluvium/fluid/fluid_space.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/run/state.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace alluvium::run
{
  struct Model;

  /** The state after the last step known to be good, kept in memory: what a run that fails leaves as its checkpoint. */
  class GoodState
  {
  public:
    /** Keep the present state of @p model, and what @p save adds for a checkpoint on the first rank. Collective.
     */
    void keep(const Model &model, const std::function<void(nlohmann::ordered_json &)> &save);

    /** The mesh is going to change, or the state is no good any more. */
    void forget() { exists = false; }

    bool         is_there() const { return exists; }
    double       time() const { return state.time; }
    unsigned int n_steps() const { return state.n_steps; }

    /**
     * Write it as the checkpoint @p folder. @p model is left with this state; contacts remember the impulses of then.
     * Collective.
     */
    void write(const std::string &folder, Model &model);

  private:
    bool                     exists = false;
    State                    state;
    fluid::BlockVector       field, before;
    grains::GrainArrays      grains;
    contacts::ContactArchive contacts;
    nlohmann::ordered_json   more;
  };
} // namespace alluvium::run
