#include <alluvium/geometry/grid_cutter.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    /** Area and moments x, y, xy about the centre, in units of the radius. */
    struct QuadrantMoments
    {
      double area = 0., x = 0., y = 0., xy = 0.;

      void add(const double sign, const QuadrantMoments &q)
      {
        area += sign * q.area;
        x += sign * q.x;
        y += sign * q.y;
        xy += sign * q.xy;
      }
    };

    /** Of the unit disc's part left of line @p a and below line @p b. */
    template <typename Line>
    inline QuadrantMoments quadrant(const Line &a, const Line &b)
    {
      const double aa = a.t * a.t, bb = b.t * b.t, beyond = aa + bb - 1.;
      if (beyond < 0.)
        return {a.t * b.t + a.g + b.g + pi / 4,
                b.t * (0.5 * (aa - 1.) + bb * (1. / 6)) - a.cube,
                a.t * (0.5 * (bb - 1.) + aa * (1. / 6)) - b.cube,
                beyond * beyond * (1. / 8)};
      // the corner lies outside: what is left are whole segments
      const double right = a.t > 0. ? 1. : 0., above = b.t > 0. ? 1. : 0.;
      return {above * (2. * a.g + pi / 2) + right * (2. * b.g + pi / 2) - right * above * pi,
              -2. * above * a.cube,
              -2. * right * b.cube,
              0.};
    }
  } // namespace


  GridCutter::GridCutter(const RectangleGrid &grid, const std::vector<PreparedPolygon> &polygons)
    : grid(&grid)
    , polygons(&polygons)
  {
    for (unsigned d = 0; d < 2; ++d)
      lines[d].resize(grid.n_lines(d));
  }


  const GridCutter::Line &GridCutter::find(const unsigned direction, const int index, const Disc &disc)
  {
    Line &line = lines[direction][index];
    if (line.user != n_discs)
      {
        const double t  = (grid->line(direction, index) - disc.centre[direction]) / disc.radius;
        line.user       = n_discs;
        line.t          = std::clamp(t, -1., 1.);
        const double s2 = (1. - line.t) * (1. + line.t), s = std::sqrt(s2);
        line.g    = 0.5 * (line.t * s + std::asin(line.t));
        line.cube = s * s2 * (1. / 3);
      }
    return line;
  }


  void GridCutter::cut(const Disc &disc, const std::vector<std::uint8_t> &wanted, std::vector<GridPiece> &pieces)
  {
    ++n_discs;
    const double r  = disc.radius;
    const auto   at = [&](const double sign) { return Point2{{disc.centre[0] + sign * r, disc.centre[1] + sign * r}}; };
    grid->for_each_cell(at(-1.), at(1.), [&](const unsigned c) {
      if (!wanted.empty() && !wanted[c])
        return;
      const RectangleGrid::Cell &cell = grid->cell(c);
      const Line                &x0 = find(0, cell.line[0][0], disc), &x1 = find(0, cell.line[0][1], disc);
      const Line                &y0 = find(1, cell.line[1][0], disc), &y1 = find(1, cell.line[1][1], disc);
      const double near_x = x0.t > 0. ? x0.t : std::min(x1.t, 0.), near_y = y0.t > 0. ? y0.t : std::min(y1.t, 0.);
      if (near_x * near_x + near_y * near_y >= 1.)
        return;
      const double far_x = std::max(-x0.t, x1.t), far_y = std::max(-y0.t, y1.t);
      if (far_x * far_x + far_y * far_y < 1.)
        {
          pieces.push_back({c, true, (*polygons)[c].area, 0.5, 0.5, 0.25});
          return;
        }
      QuadrantMoments m;
      m.add(1., quadrant(x1, y1));
      m.add(-1., quadrant(x0, y1));
      m.add(-1., quadrant(x1, y0));
      m.add(1., quadrant(x0, y0));

      // in the cell's coordinates
      const double ax = r * cell.inverse_length[0], ay = r * cell.inverse_length[1];
      GridPiece    piece{c, false, 0., 0., 0., 0.};
      double       covariance;
      if (m.area > 3e-5 * std::max({0.03, ax, ay})) // means good to 1e-11 of the cell
        {
          const double gx = m.x / m.area, gy = m.y / m.area;
          piece.area = m.area * (r * r);
          piece.xi   = (disc.centre[0] - cell.lower[0]) * cell.inverse_length[0] + gx * ax;
          piece.eta  = (disc.centre[1] - cell.lower[1]) * cell.inverse_length[1] + gy * ay;
          covariance = (m.xy / m.area - gx * gy) * (ax * ay);
        }
      else
        {
          const Overlap o = overlap(disc, (*polygons)[c]);
          if (!(o.area > 0.))
            return;
          piece.area = o.area;
          piece.xi   = (o.centroid[0] - cell.lower[0]) * cell.inverse_length[0];
          piece.eta  = (o.centroid[1] - cell.lower[1]) * cell.inverse_length[1];
          covariance = o.second_moments[1] / o.area * (cell.inverse_length[0] * cell.inverse_length[1]);
        }
      // of small pieces means are inexact: they shall be those of some piece of the cell
      piece.xi      = std::clamp(piece.xi, 0., 1.);
      piece.eta     = std::clamp(piece.eta, 0., 1.);
      piece.product = std::clamp(
        piece.xi * piece.eta + covariance, std::max(0., piece.xi + piece.eta - 1.), std::min(piece.xi, piece.eta));
      pieces.push_back(piece);
    });
  }
} // namespace alluvium::geometry
