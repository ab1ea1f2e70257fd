#pragma once

#include <array>

namespace alluvium::geometry
{
  using Point2 = std::array<double, 2>;

  /**
   * A convex triangle or quadrilateral: its first @p n (3 or 4) vertices [m], counter-clockwise. (deal.II numbers the
   * vertices of a quadrilateral lexicographically: swap the last two.)
   */
  struct ConvexPolygon
  {
    std::array<Point2, 4> vertex;
    unsigned              n = 4;
  };

  /**
   * A polygon with all that cutting it needs again and again; build it once per cell and mesh. A triangle has a fourth
   * edge of length zero, so that all loops run over four. Edge i goes from vertex i to vertex i + 1 (mod 4).
   */
  struct PreparedPolygon
  {
    PreparedPolygon() = default;

    /** Throws std::invalid_argument unless the polygon is counter-clockwise and convex with an area above zero. */
    explicit PreparedPolygon(const ConvexPolygon &);

    std::array<double, 4> x, y;                 // vertices [m]
    std::array<double, 4> tangent_x, tangent_y; // of length 1; bitwise opposite in two cells that share the edge
    Point2                lower, upper;         // bounding box [m]
    double                area;                 // [m^2]
    Point2                centroid_offset; // centroid minus vertex 0 [m]: small numbers, so that no digits are lost
    std::array<double, 3> second_moments;  // xx, xy, yy about the centroid [m^4]
  };
} // namespace alluvium::geometry
