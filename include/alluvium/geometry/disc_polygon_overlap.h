#pragma once

#include <alluvium/geometry/convex_polygon.h>

#include <array>

namespace alluvium::geometry
{
  struct Disc
  {
    Point2 centre; // [m]
    double radius; // [m], above zero
  };

  /** The piece that a disc and a polygon have in common; all zero where there is none. */
  struct Overlap
  {
    double                area           = 0.;             // [m^2]
    Point2                centroid       = {{0., 0.}};     // [m]
    std::array<double, 3> second_moments = {{0., 0., 0.}}; // integrals of (x-cx)^2 etc., xx, xy, yy [m^4]
    Point2                arm            = {{0., 0.}};     // centroid minus disc centre, all digits good [m]
  };

  /**
   * Area, centroid and second moments of the part of @p disc inside @p cell, exact to round-off: 1e-13 of the matching
   * power of min(r, cell size). Over the cells of a mesh that covers the disc, the areas add up to pi r^2, area times
   * arm to zero and the second moments (moved to the disc's centre) to the disc's own, to 1e-14 of pi r^2, pi r^3 and
   * pi r^4/4, wherever the circle meets vertices and edges. Pieces below 1e-15 min(r^2, cell area) are dropped; of all
   * others, slivers too, the centroid lies in the disc and in the cell. The disc's radius must be above zero.
   */
  Overlap overlap(const Disc &disc, const PreparedPolygon &cell);
} // namespace alluvium::geometry
