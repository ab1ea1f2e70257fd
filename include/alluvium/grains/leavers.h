#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace alluvium::grains
{
  /** What has left the domain through one open side, per unit depth. */
  struct Departure
  {
    unsigned long         n        = 0;
    double                mass     = 0.;         // [kg/m]
    std::array<double, 2> momentum = {{0., 0.}}; // when they left [N s/m]
  };

  /** The grains that have left since t = 0, by the side that they left through. */
  struct Leavers
  {
    std::map<std::string, Departure> by_side; // of all sides that are open to grains

    Departure total() const
    {
      Departure sum;
      for (const auto &[side, part] : by_side)
        {
          sum.n += part.n;
          sum.mass += part.mass;
          for (unsigned int d = 0; d < 2; ++d)
            sum.momentum[d] += part.momentum[d];
        }
      return sum;
    }
  };

  /** Of @p values, one per grain, leave those that @p keep says; nothing happens where there are none, or not as many.
   */
  template <typename T>
  void keep_some(std::vector<T> &values, const std::vector<std::uint8_t> &keep)
  {
    if (values.size() != keep.size())
      return;
    std::size_t n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (keep[i])
        values[n++] = values[i];
    values.resize(n);
  }
} // namespace alluvium::grains
