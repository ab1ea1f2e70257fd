#pragma once

#include <alluvium/geometry/disc_polygon_overlap.h>

#include <algorithm>
#include <cmath>

namespace overlap_test
{
  using namespace alluvium::geometry;

  /** Area, first moments x, y and second moments xx, xy, yy about the disc's centre, in units of its radius. */
  struct ReferenceMoments
  {
    long double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };

  /**
   * The overlap by another road than the library's, in extended precision: for each edge the part of the disc between
   * the edge and the centre, which is a triangle where the edge runs inside the circle and a sector where it runs
   * outside. No decision depends on which vertices are inside.
   */
  inline ReferenceMoments reference_overlap(const Disc &disc, const ConvexPolygon &cell)
  {
    using real = long double;
    ReferenceMoments m;
    const auto       triangle = [&](const real ax, const real ay, const real bx, const real by) {
      const real twice = ax * by - ay * bx;
      m.area += twice / 2;
      m.x += twice * (ax + bx) / 6;
      m.y += twice * (ay + by) / 6;
      m.xx += twice * (ax * ax + ax * bx + bx * bx) / 12;
      m.xy += twice * (2 * ax * ay + ax * by + bx * ay + 2 * bx * by) / 24;
      m.yy += twice * (ay * ay + ay * by + by * by) / 12;
    };
    const auto sector = [&](const real ax, const real ay, const real bx, const real by) {
      const real from = std::atan2(ay, ax);
      const real turn = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
      const real mid = from + turn / 2, s = std::sin(turn / 2);
      m.area += turn / 2;
      m.x += 2 * s * std::cos(mid) / 3;
      m.y += 2 * s * std::sin(mid) / 3;
      m.xx += (turn + std::sin(turn) * std::cos(2 * mid)) / 8;
      m.xy += std::sin(turn) * std::sin(2 * mid) / 8;
      m.yy += (turn - std::sin(turn) * std::cos(2 * mid)) / 8;
    };
    for (unsigned i = 0; i < cell.n; ++i)
      {
        const auto coordinate = [&](const unsigned k, const unsigned c) {
          return (static_cast<real>(cell.vertex[k][c]) - static_cast<real>(disc.centre[c])) /
                 static_cast<real>(disc.radius);
        };
        const unsigned j  = (i + 1) % cell.n;
        const real     ax = coordinate(i, 0), ay = coordinate(i, 1), bx = coordinate(j, 0), by = coordinate(j, 1);
        const real     dx = bx - ax, dy = by - ay, length = std::hypot(dx, dy);
        const real     tx = dx / length, ty = dy / length;
        const real     distance = (ax * dy - ay * dx) / length; // of the centre from the edge
        const real     foot     = -(ax * tx + ay * ty);         // how far along the edge
        const real     half     = std::abs(distance) < 1 ? std::sqrt((1 - distance) * (1 + distance)) : 0;
        const real     in = std::max<real>(0, foot - half), out = std::min(length, foot + half);
        if (half == 0 || in >= out)
          sector(ax, ay, bx, by);
        else
          {
            const real px = ax + in * tx, py = ay + in * ty, qx = ax + out * tx, qy = ay + out * ty;
            if (in > 0)
              sector(ax, ay, px, py);
            triangle(px, py, qx, qy);
            if (out < length)
              sector(qx, qy, bx, by);
          }
      }
    return m;
  }
} // namespace overlap_test
