#include <alluvium/geometry/smooth_disc_overlap.h>
#include <alluvium/utilities/constants.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    /** Weighted area, first and second moments about the disc's centre, in units of its radius. */
    struct SmoothMoments
    {
      double area = 0., x = 0., y = 0., xx = 0., xy = 0., yy = 0.;
    };

    /** Integral over s from 0 to 1 of s^(j + 1) w(s q): the weight's moment along a ray to the distance q, q2 = q^2. */
    template <int j>
    constexpr double along_ray(const double q2)
    {
      return 2. / (j + 2) - 2. / (j + 4) * q2;
    }

    /** The triangle from the disc's centre to an edge from a to b within the disc. */
    inline void add_triangle(SmoothMoments &m, const double ax, const double ay, const double bx, const double by)
    {
      // Gauss' points and weights on [0, 1]: along an edge the moments are of degree four
      constexpr double point[]  = {0.11270166537925831148, 0.5, 0.88729833462074168852};
      constexpr double weight[] = {5. / 18, 8. / 18, 5. / 18};
      const double     twice    = ax * by - ay * bx;
      for (unsigned int g = 0; g < 3; ++g)
        {
          const double x     = ax + point[g] * (bx - ax);
          const double y     = ay + point[g] * (by - ay);
          const double q2    = x * x + y * y;
          const double share = twice * weight[g];
          const double w1    = share * along_ray<1>(q2);
          const double w2    = share * along_ray<2>(q2);
          m.area += share * along_ray<0>(q2);
          m.x += w1 * x;
          m.y += w1 * y;
          m.xx += w2 * x * x;
          m.xy += w2 * x * y;
          m.yy += w2 * y * y;
        }
    }

    /** The sector from e counter-clockwise to f, both on the circle, with the angle @p turn between them. */
    inline void
    add_sector(SmoothMoments &m, const double ex, const double ey, const double fx, const double fy, const double turn)
    {
      constexpr double c0 = along_ray<0>(1.), c1 = along_ray<1>(1.), c2 = along_ray<2>(1.);
      const double     bend = 0.5 * (fx * fy - ex * ey);
      m.area += c0 * turn;
      m.x += c1 * (fy - ey);
      m.y += c1 * (ex - fx);
      m.xx += c2 * (0.5 * turn + bend);
      m.xy += c2 * 0.5 * (fy * fy - ey * ey);
      m.yy += c2 * (0.5 * turn - bend);
    }

    /** Where the circle crosses an edge. */
    struct Crossing
    {
      double       x, y;
      unsigned int edge;
      bool         leaving; // the edge leaves the disc there, and the piece goes on along the circle
    };

    /** @p p, or where the way from the cell's middle to it leaves the cell: round-off may put a sliver's centroid
     * there.
     */
    inline Point2 into(const PreparedPolygon &cell, const Point2 &p)
    {
      const Point2 middle = {{cell.x[0] + cell.centroid_offset[0], cell.y[0] + cell.centroid_offset[1]}};
      double       share  = 1.; // of the way
      for (unsigned int i = 0; i < 4; ++i)
        {
          const auto depth = [&](const Point2 &at) {
            return cell.tangent_x[i] * (at[1] - cell.y[i]) - cell.tangent_y[i] * (at[0] - cell.x[i]);
          };
          if (depth(p) < 0.)
            share = std::min(share, depth(middle) / (depth(middle) - depth(p)));
        }
      return {{p[0] + (1. - share) * (middle[0] - p[0]), p[1] + (1. - share) * (middle[1] - p[1])}};
    }
  } // namespace


  Overlap smooth_overlap(const Disc &disc, const PreparedPolygon &cell)
  {
    const double cx = disc.centre[0], cy = disc.centre[1], r = disc.radius;
    if (cell.lower[0] - cx >= r || cx - cell.upper[0] >= r || cell.lower[1] - cy >= r || cy - cell.upper[1] >= r)
      return {};

    // As in overlap(): in units of r, about the centre, and whether a vertex lies inside alone decides what is cut.
    const double scale = 1. / r;
    double       x[4], y[4];
    bool         inside[4];
    for (unsigned int i = 0; i < 4; ++i)
      {
        x[i]      = (cell.x[i] - cx) * scale;
        y[i]      = (cell.y[i] - cy) * scale;
        inside[i] = x[i] * x[i] + y[i] * y[i] < 1.;
      }

    // The straight sides of the piece, and where the circle joins them.
    SmoothMoments sum;
    Crossing      crossing[8];
    unsigned int  n              = 0;
    bool          centre_in_cell = true;
    for (unsigned int i = 0; i < 4; ++i)
      {
        const unsigned int j  = (i + 1) & 3;
        const double       tx = cell.tangent_x[i], ty = cell.tangent_y[i];
        const double       distance = 0.5 * ((x[i] + x[j]) * ty - (y[i] + y[j]) * tx);
        centre_in_cell              = centre_in_cell && distance > 0.;
        double ax = x[i], ay = y[i], bx = x[j], by = y[j];
        if (!inside[i] || !inside[j])
          {
            if (inside[i] == inside[j] &&
                !(std::abs(distance) < 1. && ax * tx + ay * ty < 0. && bx * tx + by * ty > 0.))
              continue;
            const double half = std::sqrt(std::max(0., (1. - distance) * (1. + distance))); // of the chord
            if (!inside[i])
              {
                ax            = distance * ty - half * tx;
                ay            = -distance * tx - half * ty;
                crossing[n++] = {ax, ay, i, false};
              }
            if (!inside[j])
              {
                bx            = distance * ty + half * tx;
                by            = -distance * tx + half * ty;
                crossing[n++] = {bx, by, i, true};
              }
          }
        add_triangle(sum, ax, ay, bx, by);
      }

    if (n == 0 && !inside[0])
      {
        if (!centre_in_cell)
          return {};
        add_sector(sum, 1., 0., 1., 0., 2. * pi);
      }
    for (unsigned int k = 0; k < n; ++k)
      if (crossing[k].leaving)
        {
          const Crossing &e = crossing[k], &f = crossing[k + 1 == n ? 0 : k + 1];
          const double    cross = e.x * f.y - e.y * f.x, dot = e.x * f.x + e.y * f.y;
          double          turn = std::atan2(cross, dot);
          if (turn < 0.)
            {
              // More than half of the circle, or none of it and round-off: the vertices outside the arc tell.
              bool far = dot <= 0.;
              for (unsigned int i = (e.edge + 1) & 3; !far; i = (i + 1) & 3)
                {
                  far = e.x * x[i] + e.y * y[i] < 0.;
                  if (i == f.edge)
                    break;
                }
              turn += far ? 2. * pi : 0.;
            }
          add_sector(sum, e.x, e.y, f.x, f.y, turn);
        }

    // Of a sliver only round-off may be left (and NaN is no area).
    if (!(sum.area > 1e-13))
      return {};

    Overlap result;
    result.area     = sum.area * (r * r);
    result.centroid = into(cell, {{cx + sum.x / sum.area * r, cy + sum.y / sum.area * r}});
    result.arm      = {{result.centroid[0] - cx, result.centroid[1] - cy}};
    const double gx = sum.x / sum.area, gy = sum.y / sum.area;
    // those of slivers are round-off, too: keep them positive semi-definite
    const double xx       = std::max(0., sum.xx - sum.x * gx);
    const double yy       = std::max(0., sum.yy - sum.y * gy);
    const double bound    = std::sqrt(xx * yy);
    const double xy       = std::min(bound, std::max(-bound, sum.xy - sum.x * gy));
    result.second_moments = {{xx * (r * r) * (r * r), xy * (r * r) * (r * r), yy * (r * r) * (r * r)}};
    return result;
  }
} // namespace alluvium::geometry
