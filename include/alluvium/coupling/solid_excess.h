#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::coupling
{
  /**
   * Nodes that hold more @p solid [m^2] than their volume hand the excess to the nodes of their cells, in proportion to
   * the room there, until none does. Returns the volume that was too much at first [m^2]. Collective.
   */
  double spread_excess(const fluid::FluidSpace<2> &space, fluid::Vector &solid);
} // namespace alluvium::coupling
