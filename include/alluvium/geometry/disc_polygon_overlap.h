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
    std::array<double, 3> second_moments = {{0., 0., 0.}}; // xx, xy, yy: integrals of (x-cx)(y-cy) etc. over the piece [m^4]
    Point2                arm            = {{0., 0.}};     // centroid minus disc centre [m], free of the centre's round-off: for torques
  };

  /**
   * Area, centroid and second moments of @p disc cut by @p cell, exact to round-off. Over the cells of a mesh that covers the disc,
   * the areas add up to pi r^2, the first moments (area times arm) to zero and the second moments to those of the disc, to 1e-14
   * relative to pi r^2, pi r^3 and pi r^4, wherever the circle meets vertices and edges. Pieces below 1e-15 min(r^2, cell area) are
   * dropped; the centroid lies in the disc and in the cell, to round-off. @p disc must have a finite centre and a radius above zero.
   */
  Overlap overlap(const Disc &disc, const PreparedPolygon &cell);
} // namespace alluvium::geometry
