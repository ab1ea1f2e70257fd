#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::fluid
{
  /**
   * The largest |u| at the nodes [m/s]: of linear elements, the largest anywhere; unlike the largest component, the
   * same in every direction. @p velocity is block 0 of a field on @p space; of ghost values, zero will do. Collective.
   */
  double largest_speed(const FluidSpace<2> &space, const Vector &velocity);
} // namespace alluvium::fluid
