#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** What one contact carries. The normal points from grain i to its partner. */
  struct ContactForce
  {
    std::uint32_t i, j; // indices into the grain arrays; j means nothing at a wall
    bool          wall;
    double        nx, ny, length;     // length: from the centre of i to that of j, or to the wall [m]
    double        normal, tangential; // [N/m]; normal > 0 presses. On the partner, along n and (-ny, nx)
  };

  /**
   * Mean stress of every grain [Pa], compression negative: the sum over its contacts of r (x) f over its area pi r^2, r
   * from its centre to the contact and f the force on it; xx, xy, yx, yy.
   */
  std::vector<std::array<double, 4>> grain_stresses(const grains::GrainArrays       &grains,
                                                    const std::vector<ContactForce> &forces);
} // namespace alluvium::contacts
