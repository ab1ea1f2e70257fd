#include <alluvium/geometry/grid_cutter.h>
#include <alluvium/utilities/constants.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    /** Weighted area and moments x, y, xy about the centre, in units of the radius. */
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

    /**
     * Of the unit disc's part left of line @p a and below line @p b. By a and b they differentiate to weight, a weight,
     * b weight and a b weight: the integral of that, plus what a line adds for itself.
     */
    template <DiscWeight weight, typename Line>
    inline QuadrantMoments quadrant(const Line &a, const Line &b)
    {
      const double aa = a.t * a.t, bb = b.t * b.t, beyond = aa + bb - 1.;
      if (beyond >= 0.)
        {
          // the corner lies outside: what is left are whole segments
          const double right = a.t > 0. ? 1. : 0., above = b.t > 0. ? 1. : 0.;
          return {above * (2. * a.zeroth + pi / 2) + right * (2. * b.zeroth + pi / 2) - right * above * pi,
                  -2. * above * a.first,
                  -2. * right * b.first,
                  0.};
        }
      if constexpr (weight == DiscWeight::top_hat)
        return {a.t * b.t + a.zeroth + b.zeroth + pi / 4,
                b.t * (0.5 * (aa - 1.) + bb * (1. / 6)) - a.first,
                a.t * (0.5 * (bb - 1.) + aa * (1. / 6)) - b.first,
                beyond * beyond * (1. / 8)};
      else
        {
          const auto first = [](const double along, const double across) {
            return along * (1. - 0.5 * along - across * (1. / 3)) - 0.5 + across * (1. / 3 - 0.1 * across);
          };
          return {2. * a.t * b.t * (1. - (aa + bb) * (1. / 3)) + a.zeroth + b.zeroth + pi / 4,
                  b.t * first(aa, bb) - a.first,
                  a.t * first(bb, aa) - b.first,
                  beyond * beyond * beyond * (-1. / 12)};
        }
    }

    /** The means of @p piece, or those of some piece of the cell: of small pieces they are inexact. */
    inline void set_means(GridPiece &piece, const double xi, const double eta, const double covariance)
    {
      piece.xi      = std::clamp(xi, 0., 1.);
      piece.eta     = std::clamp(eta, 0., 1.);
      piece.product = std::clamp(
        piece.xi * piece.eta + covariance, std::max(0., piece.xi + piece.eta - 1.), std::min(piece.xi, piece.eta));
    }
  } // namespace


  GridCutter::GridCutter(const RectangleGrid                &grid,
                         const std::vector<PreparedPolygon> &polygons,
                         const DiscWeight                    weight)
    : grid(&grid)
    , polygons(&polygons)
    , weight(weight)
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
        const double s2 = (1. - line.t) * (1. + line.t), s = std::sqrt(s2), third = s * s2 * (1. / 3);
        line.zeroth = 0.5 * (line.t * s + std::asin(line.t));
        line.first  = third;
        if (weight == DiscWeight::parabolic)
          {
            line.zeroth += line.t * third;
            line.first = 0.8 * s2 * third;
          }
      }
    return line;
  }


  void GridCutter::cut(const Disc &disc, const std::vector<std::uint8_t> &wanted, std::vector<GridPiece> &pieces)
  {
    if (weight == DiscWeight::top_hat)
      cut_with<DiscWeight::top_hat>(disc, wanted, pieces);
    else
      cut_with<DiscWeight::parabolic>(disc, wanted, pieces);
  }


  template <DiscWeight weight>
  void GridCutter::cut_with(const Disc &disc, const std::vector<std::uint8_t> &wanted, std::vector<GridPiece> &pieces)
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
      const double ax = r * cell.inverse_length[0], ay = r * cell.inverse_length[1]; // to the cell's coordinates
      const double far_x = std::max(-x0.t, x1.t), far_y = std::max(-y0.t, y1.t);
      if (far_x * far_x + far_y * far_y < 1.)
        {
          if constexpr (weight == DiscWeight::top_hat)
            pieces.push_back({c, (*polygons)[c].area, 0.5, 0.5, 0.25});
          else
            {
              // the weight is a polynomial about the cell's middle, without a mixed term
              const double mx = 0.5 * (x0.t + x1.t), my = 0.5 * (y0.t + y1.t), px = 0.5 / ax, py = 0.5 / ay;
              const double mean = 2. * (1. - mx * mx - my * my - (px * px + py * py) * (1. / 3));
              const double dx = -2. / 3 * mx * px / mean, dy = -2. / 3 * my * py / mean;
              GridPiece    piece{c, (*polygons)[c].area * mean, 0., 0., 0.};
              set_means(piece, 0.5 + dx, 0.5 + dy, -dx * dy);
              pieces.push_back(piece);
            }
          return;
        }
      QuadrantMoments m;
      m.add(1., quadrant<weight>(x1, y1));
      m.add(-1., quadrant<weight>(x0, y1));
      m.add(-1., quadrant<weight>(x1, y0));
      m.add(1., quadrant<weight>(x0, y0));

      GridPiece piece{c, m.area * (r * r), 0., 0., 0.};
      // even: means good to 1e-11 of the cell
      if (m.area > (weight == DiscWeight::top_hat ? 3e-5 * std::max({0.03, ax, ay}) : 1e-13))
        {
          const double gx = m.x / m.area, gy = m.y / m.area;
          set_means(piece,
                    (disc.centre[0] - cell.lower[0]) * cell.inverse_length[0] + gx * ax,
                    (disc.centre[1] - cell.lower[1]) * cell.inverse_length[1] + gy * ay,
                    (m.xy / m.area - gx * gy) * (ax * ay));
        }
      else
        {
          if constexpr (weight == DiscWeight::parabolic)
            return;
          const Overlap o = overlap(disc, (*polygons)[c]);
          if (!(o.area > 0.))
            return;
          piece.area = o.area;
          set_means(piece,
                    (o.centroid[0] - cell.lower[0]) * cell.inverse_length[0],
                    (o.centroid[1] - cell.lower[1]) * cell.inverse_length[1],
                    o.second_moments[1] / o.area * (cell.inverse_length[0] * cell.inverse_length[1]));
        }
      pieces.push_back(piece);
    });
  }
} // namespace alluvium::geometry
