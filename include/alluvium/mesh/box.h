#pragma once

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
} // namespace alluvium::mesh
