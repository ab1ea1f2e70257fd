#include <alluvium/geometry/convex_polygon.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace alluvium::geometry
{
  PreparedPolygon::PreparedPolygon(const ConvexPolygon &polygon)
  {
    if (polygon.n != 3 && polygon.n != 4)
      throw std::invalid_argument("A cell to cut discs with must have 3 or 4 vertices.");

    for (unsigned i = 0; i < 4; ++i)
      {
        const Point2 &p = polygon.vertex[std::min(i, polygon.n - 1)];
        x[i]            = p[0];
        y[i]            = p[1];
      }
    lower = {{*std::min_element(x.begin(), x.end()), *std::min_element(y.begin(), y.end())}};
    upper = {{*std::max_element(x.begin(), x.end()), *std::max_element(y.begin(), y.end())}};

    for (unsigned i = 0; i < polygon.n; ++i)
      {
        const unsigned j      = (i + 1) % polygon.n;
        const double   dx     = x[j] - x[i];
        const double   dy     = y[j] - y[i];
        const double   length = std::sqrt(dx * dx + dy * dy);
        tangent_x[i]          = dx / length;
        tangent_y[i]          = dy / length;
      }
    if (polygon.n == 3)
      {
        // The edge that closes a triangle becomes its fourth; the third, of length zero, takes the second's direction.
        tangent_x[3] = tangent_x[2];
        tangent_y[3] = tangent_y[2];
        tangent_x[2] = tangent_x[1];
        tangent_y[2] = tangent_y[1];
      }

    // Four turns to the left at most make one round: no turn to the right is enough. Straight angles have round-off.
    for (unsigned i = 0; i < 4; ++i)
      {
        const unsigned j = (i + 1) % 4;
        if (!(tangent_x[i] * tangent_y[j] - tangent_y[i] * tangent_x[j] > -1e-12))
          throw std::invalid_argument("A cell to cut discs with must be convex, its vertices counter-clockwise.");
      }

    // All moments about vertex 0, from the fan of triangles (0, a, b).
    double sum = 0., mx = 0., my = 0., xx = 0., xy = 0., yy = 0.;
    for (unsigned i = 1; i + 1 < polygon.n; ++i)
      {
        const double ax = x[i] - x[0], ay = y[i] - y[0];
        const double bx = x[i + 1] - x[0], by = y[i + 1] - y[0];
        const double twice = ax * by - ay * bx;
        sum += twice / 2;
        mx += twice / 6 * (ax + bx);
        my += twice / 6 * (ay + by);
        xx += twice / 12 * (ax * ax + ax * bx + bx * bx);
        xy += twice / 24 * (ax * (2 * ay + by) + bx * (ay + 2 * by));
        yy += twice / 12 * (ay * ay + ay * by + by * by);
      }
    if (!(sum > 0))
      throw std::invalid_argument(
        "A cell to cut discs with must have an area above zero, its vertices counter-clockwise.");
    area            = sum;
    centroid_offset = {{mx / sum, my / sum}};
    second_moments  = {{xx - mx * mx / sum, xy - mx * my / sum, yy - my * my / sum}};
  }
} // namespace alluvium::geometry
