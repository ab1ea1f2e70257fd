#pragma once

#include <alluvium/coupling/drag_range_record.h>
#include <alluvium/coupling/piece_drag.h>
#include <alluvium/coupling/time_scheme.h>

namespace alluvium::coupling
{
  /** Forces of the fluid on all grains together; sums over all ranks. */
  struct ForceTotals
  {
    std::array<double, 2> force         = {{0., 0.}}; // weight of displaced fluid aside [N/m]
    double                scale         = 0.;         // sum of |force| over the grains [N/m]
    double                outside_range = 0.;         // of that, on those outside the range of the drag law [N/m]
    double                torque        = 0.;         // about the origin, where rotation is coupled [N]
  };

  /** What the grains get from the fluid in a step, summed over their pieces and over ranks at once; replicated. */
  class GrainForces
  {
  public:
    /**
     * After a solve, with its exchange terms in the map: fill @p loads, and @p record grains outside the range of the
     * law of @p drag. Collective.
     */
    void collect(const CouplingState        &state,
                 const TimeScheme           &scheme,
                 const PieceDrag            &drag,
                 const fluid::FluidSpace<2> &space,
                 DragRangeRecord            &record,
                 grains::GrainLoads         &loads);

    /** Grains have come or gone: there are none until the next collect(). */
    void clear();

    /** Force of the fluid on each grain, buoyancy of the hydrostatic pressure aside [N/m]. */
    const std::vector<std::array<double, 2>> &force() const { return of_fluid; }
    /** The velocity that the fluid saw, averaged over each grain's pieces [m/s]. */
    const std::vector<std::array<double, 2>> &velocity() const { return seen_velocity; }
    const ForceTotals                        &totals() const { return sums_of_grains; }

  private:
    std::vector<std::array<double, 2>> of_fluid, seen_velocity;
    ForceTotals                        sums_of_grains;
  };
} // namespace alluvium::coupling
