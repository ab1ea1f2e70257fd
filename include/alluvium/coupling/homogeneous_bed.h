#pragma once

#include <alluvium/coupling/declarations.h>
#include <alluvium/coupling/drag_law.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::coupling
{
  /** The grains of a bed, thought of as evenly spread at one void fraction: what a drag law comes to there. */
  struct HomogeneousBed
  {
    const grains::GrainArrays    &grains;
    const fluid::FluidProperties &fluid;
    double                        eps;

    /** Whether the law gives these grains any drag. */
    bool has_drag(const DragLaw &law) const { return resistance(law, 0.) > 0.; }

    /** K [m^2] of Darcy's law U = K |grad p| / eta in creeping flow: eta eps^2 / ((1 - eps) gamma(0)); 0 without drag.
     */
    double permeability(const DragLaw &law) const;

    /**
     * Superficial velocity [m/s] at which the fluid carries the grains under gravity @p g [m/s^2]: drag and pressure
     * gradient together, sum of V gamma u / eps, are their weight less buoyancy. 0 for grains no heavier than the
     * fluid, and without drag. Grains of infinite mass are not carried.
     */
    double fluidisation_velocity(const DragLaw &law, const double g) const;

    /** Mass of the grains over their drag in creeping flow, at this void fraction [s]; 0 without drag. */
    double relaxation_time(const DragLaw &law) const;

  private:
    /** Sum of V gamma over the grains at interstitial slip @p u [N s/m^2]. */
    double resistance(const DragLaw &law, const double u) const;
  };

  /**
   * Permeability [m^2] of the bed of @p area [m^2] as the run sees it, with the void fraction at every piece of a
   * grain: K of U = K |grad p| / eta, where the gradient is the mean over the bed in creeping flow of superficial
   * velocity U through it. For flow through layers one after the other. Collective.
   */
  double permeability_of_pieces(const Coupling               &coupling,
                                const fluid::FluidSpace<2>   &space,
                                const fluid::FluidProperties &fluid,
                                const grains::GrainArrays    &grains,
                                double                        area);

  /**
   * The void fraction below which @p share of the grains' volume lies: that of the densest part of them, as the fluid
   * sees it. 1 without grains; in steps of 1e-3. Collective.
   */
  double void_fraction_of_densest(const Coupling &coupling, const fluid::FluidSpace<2> &space, const double share);

  /** Void fraction inside a bed as the fluid sees it; 1 where there is no inside. See grains/packing.h. */
  double inner_void_fraction(const grains::GrainArrays &grains);
} // namespace alluvium::coupling
