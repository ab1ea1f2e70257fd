#pragma once

#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall_motion.h>

#include <array>
#include <memory>
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

    bool rigid   = false; // moves along itself, too, as a gate that is lifted; else that is the motion of a belt
    bool present = true;  // now

    std::shared_ptr<const WallMotion> motion =
      nullptr; // what makes velocity, spin and presence; null: they stay what they are

    /** Velocity of the wall's material at (x, y) [m/s]. */
    std::array<double, 2> velocity_at(const double x, const double y) const
    {
      return {{velocity[0] - spin * (y - centre[1]), velocity[1] + spin * (x - centre[0])}};
    }
  };

  /** Parameter of the point of @p wall nearest to (x, y): 0 at a, 1 at b. */
  double project(const WallSegment &wall, double x, double y);

  /** Distance of (x, y) from @p wall [m]. */
  double distance_to(const WallSegment &wall, double x, double y);

  /** Does @p wall ever move, appear or vanish? */
  bool ever_acts(const WallSegment &wall);

  /** The largest speed of a point of @p wall [m/s]. */
  double speed_of(const WallSegment &wall);

  /** @p walls and their images beside a periodic box, under the same names: what a grain near its side may touch. */
  std::vector<WallSegment> with_images(const std::vector<WallSegment> &walls, const Periodicity &periodicity);
} // namespace alluvium::grains
