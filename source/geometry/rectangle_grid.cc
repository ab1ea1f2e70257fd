#include <alluvium/geometry/rectangle_grid.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  namespace
  {
    constexpr double tolerance = 1e-11; // of a side

    bool is_axis_parallel(const PreparedPolygon &p)
    {
      const double dx = tolerance * (p.upper[0] - p.lower[0]), dy = tolerance * (p.upper[1] - p.lower[1]);
      for (unsigned i = 0; i < 4; ++i)
        if (std::abs(p.x[i] - (i == 1 || i == 2 ? p.upper : p.lower)[0]) > dx ||
            std::abs(p.y[i] - (i >= 2 ? p.upper : p.lower)[1]) > dy)
          return false;
      return true;
    }

    /** The distinct ones of @p values, in rising order. */
    std::vector<double> distinct(std::vector<double> values, const double apart)
    {
      std::sort(values.begin(), values.end());
      values.erase(
        std::unique(values.begin(), values.end(), [&](const double a, const double b) { return b - a < apart; }),
        values.end());
      return values;
    }
  } // namespace


  RectangleGrid::RectangleGrid(const std::vector<PreparedPolygon> &polygons)
  {
    if (polygons.empty() || !std::all_of(polygons.begin(), polygons.end(), is_axis_parallel))
      return;
    std::array<double, 2> apart;
    for (unsigned d = 0; d < 2; ++d)
      {
        std::vector<double> sides;
        apart[d] = polygons[0].upper[d] - polygons[0].lower[d];
        for (const auto &p : polygons)
          {
            sides.push_back(p.lower[d]);
            sides.push_back(p.upper[d]);
            apart[d] = std::min(apart[d], p.upper[d] - p.lower[d]);
          }
        apart[d] *= tolerance;
        lines[d] = distinct(std::move(sides), apart[d]);
      }
    const std::size_t n_gaps = (lines[0].size() - 1) * (lines[1].size() - 1);
    if (n_gaps > 1000000 + 100 * polygons.size())
      return;

    cell_at.assign(n_gaps, -1);
    cells.resize(polygons.size());
    for (unsigned c = 0; c < polygons.size(); ++c)
      {
        const PreparedPolygon &p    = polygons[c];
        Cell                  &cell = cells[c];
        for (unsigned d = 0; d < 2; ++d)
          {
            const auto index = [&](const double x) {
              return static_cast<int>(std::lower_bound(lines[d].begin(), lines[d].end(), x - 2. * apart[d]) -
                                      lines[d].begin());
            };
            cell.line[d]           = {{index(p.lower[d]), index(p.upper[d])}};
            cell.lower[d]          = p.lower[d];
            cell.inverse_length[d] = 1. / (p.upper[d] - p.lower[d]);
          }
        for (int j = cell.line[1][0]; j < cell.line[1][1]; ++j)
          for (int i = cell.line[0][0]; i < cell.line[0][1]; ++i)
            cell_at[j * (lines[0].size() - 1) + i] = c;
      }
  }


  int RectangleGrid::gap(const unsigned direction, const double x) const
  {
    const auto &of   = lines[direction];
    const auto  next = std::upper_bound(of.begin(), of.end(), x);
    return std::clamp<int>(next - of.begin() - 1, 0, of.size() - 2);
  }
} // namespace alluvium::geometry
