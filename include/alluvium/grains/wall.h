#pragma once

#include <alluvium/grains/periodicity.h>

#include <array>
#include <string>
#include <vector>

namespace alluvium::grains
{
  /** A straight wall from a to b [m], solid on both sides. */
  struct WallSegment
  {
    std::array<double, 2> a, b;
    std::array<double, 2> velocity = {{0., 0.}}; // [m/s]; of the centre, if it rotates
    std::string           name;                  // what reports call it, e.g. "bottom"
    double                spin   = 0.;           // [rad/s], anticlockwise
    std::array<double, 2> centre = {{0., 0.}};   // what it rotates about [m]

    /** Velocity of the wall's material at (x, y) [m/s]. */
    std::array<double, 2> velocity_at(const double x, const double y) const
    {
      return {{velocity[0] - spin * (y - centre[1]), velocity[1] + spin * (x - centre[0])}};
    }
  };

  /** @p walls and their images beside a periodic box, under the same names: what a grain near its side may touch. */
  std::vector<WallSegment> with_images(const std::vector<WallSegment> &walls, const Periodicity &periodicity);
} // namespace alluvium::grains
