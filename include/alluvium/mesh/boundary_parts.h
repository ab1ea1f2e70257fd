#pragma once

#include <alluvium/geometry/boundary_part.h>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace alluvium::mesh
{
  /** A straight side of the boundary or of one of its cells [m]. */
  struct BoundarySide
  {
    std::array<double, 2> a, b;
    unsigned int          id;
  };

  /**
   * Parse `name = side: low < x < high; ...` (also `x < high`, `x > low`, and y) and add the parts' names to @p ids,
   * with new numbers. A side of which parts leave nothing loses its own name. Throws UserError, which starts with
   * `Domain/Named parts`, for what cannot be read, names that are in use, sides that there are not in @p sides, and
   * parts that lie on no boundary or overlap.
   */
  std::vector<geometry::BoundaryPart> parse_boundary_parts(const std::string                   &text,
                                                           const std::vector<BoundarySide>     &sides,
                                                           std::map<std::string, unsigned int> &ids);
} // namespace alluvium::mesh
