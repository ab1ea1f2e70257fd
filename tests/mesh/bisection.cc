#include <alluvium/mesh/bisection.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace
{
  using namespace alluvium::mesh;

  /** A box of @p nx by @p ny square cells, of which the lower half have @p n_near grains near them. */
  std::vector<BisectedCell> half_filled_box(const unsigned int nx, const unsigned int ny, const double n_near)
  {
    std::vector<BisectedCell> cells;
    for (unsigned int j = 0; j < ny; ++j)
      for (unsigned int i = 0; i < nx; ++i)
        cells.push_back({{i + 0.5, j + 0.5}, 2 * j < ny ? n_near : 0.});
    return cells;
  }

  struct Share
  {
    std::vector<double> n_cells, n_near;
  };

  Share share_of(const std::vector<BisectedCell> &cells, const unsigned int n_parts)
  {
    const auto part = bisect(cells, n_parts);
    Share      share{std::vector<double>(n_parts), std::vector<double>(n_parts)};
    for (std::size_t i = 0; i < cells.size(); ++i)
      {
        share.n_cells.at(part[i]) += 1.;
        share.n_near.at(part[i]) += cells[i].n_near;
      }
    return share;
  }

  TEST(Bisection, CutsATallBoxUprightWhereABedFillsItsLowerHalf)
  {
    const auto cells = half_filled_box(32, 64, 12.);
    const auto part  = bisect(cells, 2);
    for (std::size_t i = 0; i < cells.size(); ++i)
      ASSERT_EQ(part[i], cells[i].center[0] < 16. ? 0u : 1u);
  }

  TEST(Bisection, CutsTheLongerSideWhereAllCellsCostTheSame)
  {
    const auto cells = half_filled_box(32, 64, 0.);
    const auto part  = bisect(cells, 2);
    for (std::size_t i = 0; i < cells.size(); ++i)
      ASSERT_EQ(part[i], cells[i].center[1] < 32. ? 0u : 1u);
  }

  TEST(Bisection, GivesEveryPartItsShareOfCellsAndOfGrains)
  {
    for (const auto &[nx, ny] : {std::array<unsigned int, 2>{{30, 64}}, {{64, 30}}, {{50, 50}}})
      for (const unsigned int n_parts : {2, 3, 4, 5, 8})
        {
          const auto   cells      = half_filled_box(nx, ny, 12.);
          const auto   share      = share_of(cells, n_parts);
          const auto  &n_cells    = share.n_cells;
          const auto  &n_near     = share.n_near;
          const double fair_cells = double(cells.size()) / n_parts, fair_near = 6. * cells.size() / n_parts;
          // what waiting for the dearest of cutting and of solving costs, over what it must
          const double dearest = CellWeights::cost(*std::max_element(n_cells.begin(), n_cells.end()),
                                                   *std::max_element(n_near.begin(), n_near.end()));
          EXPECT_LE(dearest, 1.1 * CellWeights::cost(fair_cells, fair_near)) << nx << " x " << ny << ", " << n_parts;
        }
  }

  TEST(Bisection, LeavesNoPartEmpty)
  {
    for (const unsigned int n_parts : {1, 2, 5, 11, 12})
      {
        const auto n_cells = share_of(half_filled_box(3, 4, 1e3), n_parts).n_cells;
        EXPECT_GE(*std::min_element(n_cells.begin(), n_cells.end()), 1.) << n_parts;
      }
    EXPECT_EQ(bisect(half_filled_box(1, 2, 0.), 5).size(), 2u); // more parts than cells
    EXPECT_TRUE(bisect({}, 3).empty());
  }
} // namespace
