#include <alluvium/geometry/disc_polygon_overlap.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

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
     * Half of the angle 2a minus sin(a) cos(a), from s = sin(a) >= 0 and @p sc = sin(a) cos(a): the area between chord and arc.
     */
    inline double segment_area(const double s2, const double sc)
    {
      const double s = std::sqrt(s2);
      if (s2 < 0.02 && sc >= 0.)
        {
          // 2 sum binom(2k,k)/4^k s^(2k+3)/(2k+3): without the cancellation
          const double z = s2;
          return s * z *
                 (2. / 3 +
                  z * (1. / 5 +
                       z * (3. / 28 +
                            z * (5. / 72 +
                                 z * (35. / 704 + z * (63. / 1664 + z * (231. / 7680 + z * (429. / 17408 + z * (6435. / 311296)))))))));
        }
      return std::atan2(s, sc / s) - sc;
    }

    /**
     * Between the chord from @p e to @p f, both on the unit circle, and the arc from e counter-clockwise to f; about the circle's
     * centre. With a half the angle of the arc, s = sin(a), c = cos(a) and u the unit normal of the chord, the first moment is
     * 2/3 s^3 u and the second (S/4 - s^3 c/6) 1 + 2/3 s^3 c uu, S the area; s u is half the chord, turned.
     */
    inline Moments
    circular_segment(const double ex, const double ey, const double fx, const double fy, const double area, const double s2, const double sc)
    {
      const double ux = fy - ey, uy = ex - fx; // 2 s u
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
    if (cell.lower[0] - cx >= r || cx - cell.upper[0] >= r || cell.lower[1] - cy >= r || cy - cell.upper[1] >= r)
      return {};

    // From here on in units of r, about the centre. What two cells share comes out bitwise alike in both of them (up to the sign):
    // the vertices, the predicate `inside`, which alone decides what is cut, and the distance of an edge from the centre.
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
        result.area = cell.area;
        result.arm  = {{cell.x[0] - cx + cell.centroid_offset[0], cell.y[0] - cy + cell.centroid_offset[1]}};
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

    // The corners of the piece, counter-clockwise; leaving[k] when the boundary follows the circle from corner k to the next.
    double   px[8], py[8];
    unsigned edge[8]; // that the corner lies on
    bool     leaving[8];
    unsigned n = 0;
    for (unsigned i = 0; i < 4; ++i)
      {
        const unsigned j = (i + 1) & 3;
        if (inside[i] != inside[j] ||
            (!inside[i] && std::abs(distance[i]) < 1. && x[i] * cell.tangent_x[i] + y[i] * cell.tangent_y[i] < 0. &&
             x[j] * cell.tangent_x[i] + y[j] * cell.tangent_y[i] > 0.))
          {
            const double half = std::sqrt(std::max(0., (1. - distance[i]) * (1. + distance[i])));
            if (!inside[i])
              {
                px[n]      = distance[i] * cell.tangent_y[i] - half * cell.tangent_x[i];
                py[n]      = -distance[i] * cell.tangent_x[i] - half * cell.tangent_y[i];
                edge[n]    = i;
                leaving[n] = false;
                ++n;
              }
            if (!inside[j])
              {
                px[n]      = distance[i] * cell.tangent_y[i] + half * cell.tangent_x[i];
                py[n]      = -distance[i] * cell.tangent_x[i] + half * cell.tangent_y[i];
                edge[n]    = i;
                leaving[n] = true;
                ++n;
              }
          }
        if (inside[j])
          {
            px[n]      = x[j];
            py[n]      = y[j];
            leaving[n] = false;
            ++n;
          }
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

    const double cell_area = cell.area * scale * scale;
    const double small     = std::min(1., cell_area);
    if (!(sum.area > 1e-15 * small))
      return {};

    double gx = sum.x / sum.area, gy = sum.y / sum.area;
    double xx = sum.xx - sum.x * gx, xy = sum.xy - sum.x * gy, yy = sum.yy - sum.y * gy;
    gx += px[0];
    gy += py[0];
    if (sum.area < 1e-10 * small)
      {
        // The centroid of a sliver is its round-off: back to the nearest point of cell and disc. So are its second moments.
        for (unsigned pass = 0; pass < 3; ++pass)
          {
            for (unsigned i = 0; i < 4; ++i)
              {
                const double outside =
                  std::min(0., distance[i] + cell.tangent_x[i] * gy - cell.tangent_y[i] * gx);
                gx += outside * cell.tangent_y[i];
                gy -= outside * cell.tangent_x[i];
              }
            const double length = std::max(1., std::sqrt(gx * gx + gy * gy));
            gx /= length;
            gy /= length;
          }
        xx                  = std::max(0., xx);
        yy                  = std::max(0., yy);
        const double bound = std::sqrt(xx * yy);
        xy                  = std::min(bound, std::max(-bound, xy));
      }

    Overlap result;
    result.area           = sum.area * (r * r);
    result.arm            = {{gx * r, gy * r}};
    result.centroid       = {{cx + result.arm[0], cy + result.arm[1]}};
    result.second_moments = {{xx * (r * r) * (r * r), xy * (r * r) * (r * r), yy * (r * r) * (r * r)}};
    return result;
  }
} // namespace alluvium::geometry
