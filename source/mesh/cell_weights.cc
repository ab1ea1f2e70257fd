#include <alluvium/mesh/cell_weights.h>

#include <algorithm>
#include <cmath>

namespace alluvium::mesh
{
  namespace
  {
    constexpr double cell_cost = 1000.;
    // a piece costs about a twentieth of an empty cell's assembly and solve: tests/benchmarks/fluid_step.cc
    constexpr double piece_cost  = 50.;
    constexpr double max_buckets = 1e6;
  } // namespace


  void CellWeights::count(const std::vector<double> &x, const std::vector<double> &y, const double new_reach)
  {
    reach = new_reach;
    sum.clear();
    if (x.empty())
      return;
    const auto   range_x = std::minmax_element(x.begin(), x.end()), range_y = std::minmax_element(y.begin(), y.end());
    const double width = *range_x.second - *range_x.first, height = *range_y.second - *range_y.first;
    lower = {{*range_x.first, *range_y.first}};
    side  = std::max({0.5 * reach, std::sqrt(width * height / max_buckets), std::max(width, height) / max_buckets});
    n     = {{1 + std::size_t(width / side), 1 + std::size_t(height / side)}};
    sum.assign((n[0] + 1) * (n[1] + 1), 0.);
    const auto at = [&](const std::size_t i, const std::size_t j) -> double & { return sum[j * (n[0] + 1) + i]; };
    for (std::size_t g = 0; g < x.size(); ++g)
      at(1 + std::min(n[0] - 1, std::size_t((x[g] - lower[0]) / side)),
         1 + std::min(n[1] - 1, std::size_t((y[g] - lower[1]) / side))) += 1.;
    for (std::size_t j = 1; j <= n[1]; ++j)
      for (std::size_t i = 1; i <= n[0]; ++i)
        at(i, j) += at(i - 1, j) + at(i, j - 1) - at(i - 1, j - 1);
  }


  double CellWeights::n_near(const Box &box) const
  {
    if (sum.empty())
      return 0.;
    std::array<std::array<std::size_t, 2>, 2> corner; // [low, high][direction], nearest raster lines
    for (unsigned int d = 0; d < 2; ++d)
      for (unsigned int end = 0; end < 2; ++end)
        {
          const double x = end == 0 ? box.lower[d] - reach : box.upper[d] + reach;
          corner[end][d] = std::size_t(std::clamp(std::round((x - lower[d]) / side), 0., double(n[d])));
        }
    const auto at = [&](const unsigned int a, const unsigned int b) {
      return sum[corner[b][1] * (n[0] + 1) + corner[a][0]];
    };
    return at(1, 1) - at(0, 1) - at(1, 0) + at(0, 0);
  }


  double CellWeights::cost(const double n_cells, const double n_near)
  {
    return cell_cost * n_cells + piece_cost * n_near;
  }


  unsigned int CellWeights::weight(const Box &box) const
  {
    return static_cast<unsigned int>(std::min(1e8, cost(1., n_near(box))));
  }
} // namespace alluvium::mesh
