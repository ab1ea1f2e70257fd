#pragma once

#include <alluvium/contacts/search/contact_archive.h>
#include <alluvium/fluid/fluid_space.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/leavers.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /** The state after the last step known to be good, kept in memory: what a run that fails leaves as its checkpoint. */
  class GoodState
  {
  public:
    /** Keep the present state of @p model, and what @p save adds for a checkpoint on the rank that speaks. Collective.
     */
    void keep(const Model &model, const std::function<void(nlohmann::ordered_json &)> &save);

    /** The mesh is going to change, or the state is no good any more. */
    void forget() { exists = false; }

    bool         is_there() const { return exists; }
    double       time() const { return at_time; }
    unsigned int n_steps() const { return at_step; }

    /**
     * Write it as the checkpoint @p folder. @p model is left with this state; contacts remember the impulses of then.
     * Collective.
     */
    void write(const std::string &folder, Model &model);

  private:
    bool                          exists  = false;
    double                        at_time = 0.;
    unsigned int                  at_step = 0;
    fluid::BlockVector            field, before;
    grains::GrainArrays           grains;
    std::vector<std::uint8_t>     touched;
    contacts::ContactArchive      contacts;
    grains::Leavers               leavers;
    std::map<std::string, double> counts;
    nlohmann::ordered_json        more;
  };
} // namespace alluvium::run
