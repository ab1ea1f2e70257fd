#pragma once

#include <alluvium/grains/bed_faces.h>
#include <alluvium/grains/leavers.h>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace alluvium::run
{
  /** Time as a multiple of the time step, counted from where a restart changed that: sums would gather round-off. */
  struct Clock
  {
    double       since   = 0.; // [s]
    unsigned int n_steps = 0;  // then
    double       dt      = 0.; // since then [s]

    double at(const unsigned int n) const { return since + (n - n_steps) * dt; }
  };

  /**
   * What a run has come to besides grains, flow and contacts, which their rooms keep. Checkpoints and the last good
   * state hold all of it: what is added here is in both, once save() and load() know it.
   */
  struct State
  {
    double                        time    = 0.; // [s]
    unsigned int                  n_steps = 0;
    Clock                         clock;
    std::vector<std::uint8_t>     touched; // per grain: by others in the last step
    grains::Leavers               leavers;
    grains::BedFaces              initial_bed;
    double                        initial_diameter = 0.;    // mean of the grains at t = 0, `d` in formulas [m]
    double                        coarse_size      = 0.;    // cells of the unrefined mesh [m]
    bool                          never_refines    = false; // the mesh stays as it was made
    std::map<std::string, double> counts;                   // steps, sweeps, iterations ...

    std::map<std::string, std::string> inputs; // digests of the files that the grains were made of, by path; on rank 0

    /** All but `touched`, which checkpoints keep beside the contacts. */
    void save(nlohmann::ordered_json &json) const;

    /** Throws nlohmann's exceptions if @p json is not what save() has written. */
    void load(const nlohmann::ordered_json &json);
  };
} // namespace alluvium::run
