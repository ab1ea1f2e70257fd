#pragma once

#include <array>
#include <string>
#include <vector>

namespace alluvium::geometry
{
  /** A part of a side that has a name of its own: where the side's coordinate `axis` is between low and high [m]. */
  struct BoundaryPart
  {
    std::string  name, side_name;
    unsigned int id, side; // of the part, and of the side that it is taken from
    unsigned int axis;     // 0: x, 1: y
    double       low, high;
  };

  /** What of a straight face belongs to the boundary @p id: from begin to end, 0 its first point, 1 its second. */
  struct FacePart
  {
    unsigned int id;
    double       begin, end;

    bool has_first() const { return begin == 0.; }
    bool has_second() const { return end == 1.; }
    bool is_whole() const { return begin == 0. && end == 1.; }
  };

  /**
   * Divide the face from @p a to @p b of the side @p id among @p parts and what the side keeps, from a to b. Ends that
   * lie within 1e-9 of the face's length of a point of it lie there.
   */
  std::vector<FacePart> divide_face(const std::vector<BoundaryPart> &parts,
                                    const unsigned int               id,
                                    const std::array<double, 2>     &a,
                                    const std::array<double, 2>     &b);
} // namespace alluvium::geometry
