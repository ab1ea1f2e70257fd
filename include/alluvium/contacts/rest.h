#pragma once

#include <alluvium/contacts/contact_report.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/utilities/checked_file.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /**
   * Knows when a bed is at rest: over some steps the load of every grain has stayed the same, and none has
   * moved by more than a constant acceleration of 4e-4 g would have moved it. What motion there is then is the
   * contact solver's tolerance. While the loads stay what they are, nothing needs to be solved: the grains sleep,
   * exactly, and their contact forces are what their loads ask for. The first change ends the rest.
   */
  class Rest
  {
  public:
    /** Scales of one step. */
    struct Scales
    {
      double dt;       // [s]
      double g;        // [m/s^2]; without gravity nothing rests
      double weight;   // of a mean grain [N/m]
      double diameter; // the smallest [m]
    };

    /** Steps without change before the grains are taken to rest; 0: they never are. */
    unsigned int steps = 10;

    /** Of the box: a grain that crosses its periodic boundary has not moved by its length. */
    grains::Periodicity periodicity;

    /** Whether @p grains may stay as they are under @p loads. */
    bool holds(const grains::GrainArrays &grains, const grains::GrainLoads &loads, const Scales &scales) const;

    /** Let the grains sleep; the report and the contacts are those of the last step that was solved. */
    ContactReport
    stand_still(const grains::GrainLoads &loads, grains::GrainArrays &grains, std::vector<std::uint8_t> &touched) const;

    /** Take note of a step that was solved; fills n_quiet of its report. */
    void watch(const grains::GrainArrays       &grains,
               const grains::GrainLoads        &loads,
               const Scales                    &scales,
               const std::vector<std::uint8_t> &touched,
               ContactReport                   &report);

    void forget() { n_quiet = 0; }

    void save(ByteWriter &writer) const;
    void load(ByteReader &reader); // throws std::runtime_error if @p reader ends

  private:
    unsigned int                 n_quiet = 0; // steps since the references
    std::vector<grains::GrainId> id;
    std::vector<double>          x, y, fx, fy; // positions and loads that have not changed since
    ContactReport                last_report;
    std::vector<std::uint8_t>    last_touched;

    /** In the last of which grains were slow from beginning to end: its forces balance. */
    unsigned int least_steps() const { return std::max(steps, 2u); }
    bool         is_known() const { return steps > 0 && n_quiet >= least_steps(); }

    /** Whether places and loads are those of the references. */
    bool unchanged(const grains::GrainArrays &grains, const grains::GrainLoads &loads, const Scales &scales) const;
  };
} // namespace alluvium::contacts
