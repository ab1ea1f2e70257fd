#pragma once

#include <array>
#include <cmath>

namespace alluvium::geometry
{
  /**
   * Coordinates in which gravity, or the axis nearest to it, points downwards: `across` and `height`. Where it is along
   * -y these are x and y.
   */
  struct Upright
  {
    unsigned int vertical = 1;  // the axis of heights: 0 or 1
    double       sign     = 1.; // of heights along it

    /** For @p gravity [m/s^2]; that of -y for none. */
    static Upright of(const std::array<double, 2> &gravity)
    {
      Upright result;
      result.vertical = std::abs(gravity[0]) > std::abs(gravity[1]) ? 0 : 1;
      result.sign     = gravity[result.vertical] > 0. ? -1. : 1.;
      return result;
    }

    bool is_default() const { return vertical == 1 && sign == 1.; }

    /** (across, height) of the point @p x, and back. */
    std::array<double, 2> to(const std::array<double, 2> &x) const { return {{x[1 - vertical], sign * x[vertical]}}; }
    std::array<double, 2> from(const std::array<double, 2> &x) const
    {
      return vertical == 1 ? std::array<double, 2>{{x[0], sign * x[1]}} : std::array<double, 2>{{sign * x[1], x[0]}};
    }

    /** Turn a box, given by its corners. */
    void turn(std::array<double, 2> &lower, std::array<double, 2> &upper) const
    {
      const auto a = to(lower), b = to(upper);
      for (unsigned int d = 0; d < 2; ++d)
        {
          lower[d] = std::fmin(a[d], b[d]);
          upper[d] = std::fmax(a[d], b[d]);
        }
    }
  };
} // namespace alluvium::geometry
