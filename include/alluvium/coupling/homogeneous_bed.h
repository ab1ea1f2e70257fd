#pragma once

#include <alluvium/coupling/drag_law.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::fluid
{
  struct FluidProperties;
}

namespace alluvium::coupling
{
  /** The grains of a bed, thought of as evenly spread at one void fraction: what a drag law comes to there. */
  struct HomogeneousBed
  {
    const grains::GrainArrays    &grains;
    const fluid::FluidProperties &fluid;
    double                        eps;

    /** K [m^2] of Darcy's law U = K |grad p| / eta in creeping flow: eta eps^2 / ((1 - eps) gamma(0)). */
    double permeability(const DragLaw &law) const;

    /**
     * Superficial velocity [m/s] at which the fluid carries the grains under gravity @p g [m/s^2]: drag and pressure
     * gradient together, sum of V gamma u / eps, are their weight less buoyancy. 0 for grains no heavier than the
     * fluid.
     */
    double fluidisation_velocity(const DragLaw &law, const double g) const;

  private:
    /** Sum of V gamma over the grains at interstitial slip @p u [N s/m^2]. */
    double resistance(const DragLaw &law, const double u) const;
  };

  /** Void fraction inside a bed as the fluid sees it; 1 where there is no inside. See grains/packing.h. */
  double inner_void_fraction(const grains::GrainArrays &grains);
} // namespace alluvium::coupling
