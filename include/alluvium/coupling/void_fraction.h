#pragma once

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/interphase.h>

namespace alluvium::coupling
{
  /**
   * Row-sum lumped void fraction (paper (9)) at the nodes: 1 - sum over @p pieces of A phi_i / integral of phi_i. Where
   * that falls below zero (never with the moments rule on parallelograms), it is set to zero and the solid in excess
   * goes to the neighbouring nodes. Returns the volume moved so [m^2]. Collective.
   */
  double
  lumped_void_fraction(const fluid::InterphaseTerms<2> &pieces, const fluid::FluidSpace<2> &space, fluid::Vector &eps);
} // namespace alluvium::coupling
