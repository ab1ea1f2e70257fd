#pragma once

#include <alluvium/grains/wall.h>

#include <optional>

namespace alluvium::grains
{
  /**
   * Where @p wall crosses the line at height @p y [m], if it does: x [m]. An end belongs to the part above, so that a
   * closed boundary is crossed an even number of times, and an odd number of times to the right of a point inside.
   */
  inline std::optional<double> crossing(const WallSegment &wall, const double y)
  {
    if ((wall.a[1] > y) == (wall.b[1] > y))
      return {};
    return wall.a[0] + (y - wall.a[1]) / (wall.b[1] - wall.a[1]) * (wall.b[0] - wall.a[0]);
  }
} // namespace alluvium::grains
