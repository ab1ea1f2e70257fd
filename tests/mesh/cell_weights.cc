#include <alluvium/mesh/cell_weights.h>

#include <gtest/gtest.h>

namespace
{
  using namespace alluvium::mesh;

  TEST(CellWeights, CountTheGrainsThatReachIntoACell)
  {
    // a grain at the middle of each cell of a 40 x 20 raster of side 0.1, from (0, 0)
    std::vector<double> x, y;
    for (unsigned int j = 0; j < 20; ++j)
      for (unsigned int i = 0; i < 40; ++i)
        {
          x.push_back(0.1 * (i + 0.5));
          y.push_back(0.1 * (j + 0.5));
        }
    CellWeights weights;
    weights.count(x, y, 0.2);
    EXPECT_EQ(weights.n_near({{{-1., -1.}}, {{5., 3.}}}), 800.);
    EXPECT_EQ(weights.n_near({{{10., 10.}}, {{11., 11.}}}), 0.);
    const double n = weights.n_near({{{1., 1.}}, {{1.4, 1.4}}}); // 0.8 wide with its surroundings
    EXPECT_GE(n, 49.);
    EXPECT_LE(n, 81.);
    EXPECT_EQ(weights.weight({{{10., 10.}}, {{11., 11.}}}), 1000u);
    EXPECT_GT(weights.weight({{{1., 1.}}, {{1.4, 1.4}}}), 3000u);
  }

  TEST(CellWeights, WithoutGrainsAllCellsCostTheSame)
  {
    CellWeights weights;
    weights.count({}, {}, 1.);
    EXPECT_EQ(weights.weight({{{0., 0.}}, {{1., 1.}}}), 1000u);
    // all on one spot: a raster of no extent
    weights.count({0.5, 0.5}, {0.5, 0.5}, 0.1);
    EXPECT_EQ(weights.n_near({{{0., 0.}}, {{1., 1.}}}), 2.);
  }
} // namespace
