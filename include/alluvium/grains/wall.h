#pragma once

#include <array>
#include <string>
#include <vector>

namespace alluvium::grains
{
  /** A straight wall from a to b [m], solid on both sides, moving with a given velocity [m/s]. */
  struct WallSegment
  {
    std::array<double, 2> a, b;
    std::array<double, 2> velocity = {{0., 0.}};
    std::string           name; // what reports call it, e.g. "bottom"
  };
} // namespace alluvium::grains
