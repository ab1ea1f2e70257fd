#pragma once

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/interphase.h>

namespace alluvium::fluid
{
  /**
   * Means of the shape functions of @p cell, which has @p n_nodes (3 or 4), over a piece, the intersection of a grain
   * and the cell, with this @p area [m^2] and
   * @p centroid [m]: exact for linear functions, and on parallelograms for xi eta with the @p second_moments of the
   * piece about its centroid, xx, xy, yy [m^4]; with zeros they are the values at the centroid.
   */
  PieceShape<2> piece_shape(const CellData<2>           &cell,
                            const unsigned int           n_nodes,
                            const double                 area,
                            const std::array<double, 2> &centroid,
                            const std::array<double, 3> &second_moments);
} // namespace alluvium::fluid
