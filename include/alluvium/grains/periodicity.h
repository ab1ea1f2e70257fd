#pragma once

#include <array>
#include <cmath>

namespace alluvium::grains
{
  /** A box that repeats itself in x, in y, in both or in none: what leaves it at one side enters at the other. */
  struct Periodicity
  {
    std::array<double, 2> lower  = {{0., 0.}}; // [m]
    std::array<double, 2> length = {{0., 0.}}; // [m]; 0: not periodic in this direction

    bool any() const { return length[0] > 0. || length[1] > 0.; }

    /** Make (dx, dy), between two points of the box, the distance to the nearest image. */
    void shorten(double &dx, double &dy) const
    {
      to_nearest(dx, length[0]);
      to_nearest(dy, length[1]);
    }

    /** Move coordinate @p x in direction @p d into the box, and @p x0 by as much. */
    void wrap(double &x, double &x0, const unsigned int d) const
    {
      if (!(length[d] > 0.))
        return;
      const double shift = -length[d] * std::floor((x - lower[d]) / length[d]);
      x += shift;
      x0 += shift;
    }

  private:
    static void to_nearest(double &dx, const double length)
    {
      if (length > 0.)
        {
          if (dx > 0.5 * length)
            dx -= length;
          else if (dx < -0.5 * length)
            dx += length;
        }
    }
  };
} // namespace alluvium::grains
