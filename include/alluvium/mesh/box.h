#pragma once

#include <algorithm>
#include <array>

namespace alluvium::mesh
{
  /** A rectangle along the axes [m]. */
  struct Box
  {
    std::array<double, 2> lower{}, upper{};
  };

  /** @p box, wider by @p width [m] on all sides. */
  inline Box widened(const Box &box, const double width)
  {
    return {{{box.lower[0] - width, box.lower[1] - width}}, {{box.upper[0] + width, box.upper[1] + width}}};
  }

  /** The box around @p cell, widened on all sides by @p margin times its own size. */
  template <typename Cell>
  Box box_of(const Cell &cell, const double margin = 0.)
  {
    Box box{{{cell->vertex(0)[0], cell->vertex(0)[1]}}, {{cell->vertex(0)[0], cell->vertex(0)[1]}}};
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int d = 0; d < 2; ++d)
        {
          box.lower[d] = std::min(box.lower[d], cell->vertex(v)[d]);
          box.upper[d] = std::max(box.upper[d], cell->vertex(v)[d]);
        }
    for (unsigned int d = 0; d < 2; ++d)
      {
        const double widen = margin * (box.upper[d] - box.lower[d]);
        box.lower[d] -= widen;
        box.upper[d] += widen;
      }
    return box;
  }
} // namespace alluvium::mesh
