#pragma once

#include <alluvium/coupling/coupling_state.h>

namespace alluvium::coupling
{
  /** Velocity of a piece (intersection of a grain and a cell) as the fluid saw it in the latest solve [m/s], and the
   * force density on it [N/m^3]. */
  struct PieceForce
  {
    std::array<double, 2> velocity, force;
  };

  /** Of piece @p k with the exchange terms of @p map, from the fluid in @p state: see fluid::PieceExchange. */
  PieceForce piece_force(const OverlapMap &map, const PieceState &state, const std::size_t k);

  /**
   * Sum of the sizes of what those forces are made of, gamma |u|, gamma |v| and |grad p|, on this rank [N/m]. Where
   * grains drift along with a fluid the forces are far smaller, down to what the digits leave of a difference.
   */
  double size_of_parts(const OverlapMap &map, const PieceState &state);
} // namespace alluvium::coupling
