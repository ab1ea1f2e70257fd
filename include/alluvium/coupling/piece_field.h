#pragma once

#include <alluvium/coupling/overlap_map.h>

namespace alluvium::coupling
{
  /** Fluid velocity [m/s] and reduced pressure gradient [Pa/m] at one piece, the intersection of a grain and a cell. */
  struct PieceField
  {
    std::array<double, 2> u, grad_p;
  };

  /** Mean velocity and pressure gradient of @p field over each piece of @p map. */
  void evaluate(const OverlapMap           &map,
                const fluid::FluidSpace<2> &space,
                const fluid::BlockVector   &field,
                std::vector<PieceField>    &result);

  /** Gradient of the fluid velocity at a piece's centroid, [component][direction] [1/s]. */
  using VelocityGradient = std::array<std::array<double, 2>, 2>;
  std::vector<VelocityGradient>
  velocity_gradients(const OverlapMap &map, const fluid::FluidSpace<2> &space, const fluid::BlockVector &field);
} // namespace alluvium::coupling
