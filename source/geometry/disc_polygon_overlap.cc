#include <alluvium/geometry/disc_polygon_overlap.h>
#include <alluvium/utilities/constants.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    /** Area, first moments x, y and second moments xx, xy, yy of a piece about some origin. */
    struct Moments
    {
      double area = 0., x = 0., y = 0., xx = 0., xy = 0., yy = 0.;
    };

    /** The moments of @p m about @p (ox, oy) instead of the origin. */
    inline Moments shifted(const Moments &m, const double ox, const double oy)
    {
      return {m.area,
              m.x - m.area * ox,
              m.y - m.area * oy,
              m.xx - (2 * m.x - m.area * ox) * ox,
              m.xy - m.x * oy - (m.y - m.area * oy) * ox,
              m.yy - (2 * m.y - m.area * oy) * oy};
    }

    inline void operator+=(Moments &a, const Moments &b)
    {
      a.area += b.area;
      a.x += b.x;
      a.y += b.y;
      a.xx += b.xx;
      a.xy += b.xy;
      a.yy += b.yy;
    }

    /** Triangle with corners 0, a, b, about 0. */
    inline Moments triangle(const double ax, const double ay, const double bx, const double by)
    {
      const double twice = ax * by - ay * bx;
      return {twice * (1. / 2),
              twice * (1. / 6) * (ax + bx),
              twice * (1. / 6) * (ay + by),
              twice * (1. / 12) * (ax * ax + ax * bx + bx * bx),
              twice * (1. / 24) * (ax * (2 * ay + by) + bx * (ay + 2 * by)),
              twice * (1. / 12) * (ay * ay + ay * by + by * by)};
    }

    /**
     * Area between chord and arc on the unit circle. With a half the angle of the arc, 0 <= a <= pi: @p s2 = sin(a)^2,
     * @p sc = sin(a) cos(a).
     */
    inline double segment_area(const double s2, const double sc)
    {
      const double s = std::sqrt(s2);
      if (s2 < 0.02 && sc >= 0.)
        {
          // a - sin(a) cos(a) without its cancellation: sum over k of 2 binom(2k, k)/4^k s^(2k + 3)/(2k + 3)
          constexpr double c[] = {
            2. / 3, 1. / 5, 3. / 28, 5. / 72, 35. / 704, 63. / 1664, 231. / 7680, 429. / 17408, 6435. / 311296};
          double sum = c[8];
          for (int k = 7; k >= 0; --k)
            sum = sum * s2 + c[k];
          return s * s2 * sum;
        }
      return std::atan2(s, sc / s) - sc;
    }

    /**
     * Between the chord from e to f, both on the unit circle, and the arc from e counter-clockwise to f; about the
     * circle's centre. With s = sin(a), c = cos(a), a as above, and u the unit normal of the chord, the first moment is
     * 2/3 s^3 u and the second (S/4 - s^3 c/6) 1 + 2/3 s^3 c uu, S the @p area. The chord, turned, is 2 s u.
     */
    inline Moments circular_segment(const double ex,
                                    const double ey,
                                    const double fx,
                                    const double fy,
                                    const double area,
                                    const double s2,
                                    const double sc)
    {
      const double ux = fy - ey, uy = ex - fx;
      const double diagonal = area * (1. / 4) - s2 * sc * (1. / 6);
      return {area,
              s2 * (1. / 3) * ux,
              s2 * (1. / 3) * uy,
              diagonal + sc * (1. / 6) * ux * ux,
              sc * (1. / 6) * ux * uy,
              diagonal + sc * (1. / 6) * uy * uy};
    }
  } // namespace


  Overlap overlap(const Disc &disc, const PreparedPolygon &cell)
  {
    const double cx = disc.centre[0], cy = disc.centre[1], r = disc.radius;
    Assert(r > 0. && std::isfinite(cx) && std::isfinite(cy), dealii::ExcMessage("Only a disc can be cut."));
    if (cell.lower[0] - cx >= r || cx - cell.upper[0] >= r || cell.lower[1] - cy >= r || cy - cell.upper[1] >= r)
      return {};

    // From here on in units of r, about the centre. What two cells share comes out bitwise alike in both of them (up to
    // the sign): the vertices, the predicate `inside`, which alone decides what is cut, and the distance of an edge
    // from the centre.
    const double scale = 1. / r;
    double       x[4], y[4], distance[4];
    bool         inside[4];
    for (unsigned i = 0; i < 4; ++i)
      {
        x[i]      = (cell.x[i] - cx) * scale;
        y[i]      = (cell.y[i] - cy) * scale;
        inside[i] = x[i] * x[i] + y[i] * y[i] < 1.;
      }
    if (inside[0] && inside[1] && inside[2] && inside[3])
      {
        Overlap result;
        result.area           = cell.area;
        result.arm            = {{cell.x[0] - cx + cell.centroid_offset[0], cell.y[0] - cy + cell.centroid_offset[1]}};
        result.centroid       = {{cell.x[0] + cell.centroid_offset[0], cell.y[0] + cell.centroid_offset[1]}};
        result.second_moments = cell.second_moments;
        return result;
      }
    // Signed distance of the centre from the edge, positive on the cell's side: symmetric in the end points.
    for (unsigned i = 0; i < 4; ++i)
      {
        const unsigned j = (i + 1) & 3;
        distance[i]      = 0.5 * ((x[i] + x[j]) * cell.tangent_y[i] - (y[i] + y[j]) * cell.tangent_x[i]);
      }

    // The corners of the piece, counter-clockwise; leaving[k] if the circle, not an edge, leads from corner k to the
    // next.
    double     px[8], py[8];
    unsigned   edge[8]; // that the corner lies on
    bool       leaving[8];
    unsigned   n          = 0;
    const auto add_corner = [&](const double x, const double y, const unsigned i, const bool leaves) {
      px[n]      = x;
      py[n]      = y;
      edge[n]    = i;
      leaving[n] = leaves;
      ++n;
    };
    for (unsigned i = 0; i < 4; ++i)
      {
        const unsigned j  = (i + 1) & 3;
        const double   tx = cell.tangent_x[i], ty = cell.tangent_y[i];
        // An edge between an inside and an outside vertex is cut once, one between two outside vertices twice or never.
        if (inside[i] != inside[j] ||
            (!inside[i] && std::abs(distance[i]) < 1. && x[i] * tx + y[i] * ty < 0. && x[j] * tx + y[j] * ty > 0.))
          {
            const double half = std::sqrt(std::max(0., (1. - distance[i]) * (1. + distance[i]))); // of the chord
            if (!inside[i])
              add_corner(distance[i] * ty - half * tx, -distance[i] * tx - half * ty, i, false);
            if (!inside[j])
              add_corner(distance[i] * ty + half * tx, -distance[i] * tx + half * ty, i, true);
          }
        if (inside[j])
          add_corner(x[j], y[j], i, false);
      }

    if (n == 0)
      {
        // The circle meets no edge and no vertex lies inside: the disc is wholly inside or wholly outside.
        Overlap result;
        if (distance[0] > 0. && distance[1] > 0. && distance[2] > 0. && distance[3] > 0.)
          {
            result.area           = pi * r * r;
            result.centroid       = disc.centre;
            result.second_moments = {{result.area * r * r / 4, 0., result.area * r * r / 4}};
          }
        return result;
      }

    // The polygon of the corners as a fan about the first corner, where small pieces keep their digits ...
    Moments sum;
    for (unsigned k = 1; k + 1 < n; ++k)
      sum += triangle(px[k] - px[0], py[k] - py[0], px[k + 1] - px[0], py[k + 1] - py[0]);

    // ... and what lies between it and the circle.
    for (unsigned k = 0; k < n; ++k)
      if (leaving[k])
        {
          const unsigned l  = (k + 1 == n ? 0 : k + 1);
          const double   dx = px[l] - px[k], dy = py[l] - py[k];
          const double   s2 = (dx * dx + dy * dy) * (1. / 4);
          const double   sc = (px[k] * py[l] - py[k] * px[l]) * (1. / 2);
          double         area;
          if (sc < 0. && px[k] * px[l] + py[k] * py[l] > 0.)
            {
              // Above 3/4 of the circle, or none of it and round-off: the polygon's vertices outside the arc tell.
              bool far = false;
              for (unsigned i = (edge[k] + 1) & 3;; i = (i + 1) & 3)
                {
                  far = far || px[k] * x[i] + py[k] * y[i] < 0.;
                  if (i == edge[l])
                    break;
                }
              area = (far ? pi : 0.) - segment_area(s2, -sc);
            }
          else
            area = segment_area(s2, sc);
          sum += shifted(circular_segment(px[k], py[k], px[l], py[l], area, s2, sc), px[0], py[0]);
        }

    // Below this an area is round-off (and NaN is no area).
    if (!(sum.area > 1e-15 * std::min(1., cell.area * scale * scale)))
      return {};

    // About a corner the centroid is an average of points of the piece: even that of a sliver lies inside.
    const double gx = sum.x / sum.area, gy = sum.y / sum.area;

    // Of thin pieces the second moments are round-off: keep them positive semi-definite.
    const double xx    = std::max(0., sum.xx - sum.x * gx);
    const double yy    = std::max(0., sum.yy - sum.y * gy);
    const double bound = std::sqrt(xx * yy);
    const double xy    = std::min(bound, std::max(-bound, sum.xy - sum.x * gy));

    Overlap result;
    result.area           = sum.area * (r * r);
    result.arm            = {{(px[0] + gx) * r, (py[0] + gy) * r}};
    result.centroid       = {{cx + result.arm[0], cy + result.arm[1]}};
    result.second_moments = {{xx * (r * r) * (r * r), xy * (r * r) * (r * r), yy * (r * r) * (r * r)}};
    return result;
  }
} // namespace alluvium::geometry
