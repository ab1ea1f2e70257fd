// The packing of a bed, measured in the bed wherever it stands.
#include <alluvium/grains/bed_packing.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace alluvium;

namespace
{
  constexpr double d = 1e-3;

  /** Square lattice of @p nx by @p ny touching discs from (@p x, @p y) up: packing pi / 4. */
  void add_block(grains::GrainArrays &g, const double x, const double y, const unsigned int nx, const unsigned int ny)
  {
    for (unsigned int j = 0; j < ny; ++j)
      for (unsigned int i = 0; i < nx; ++i)
        {
          const std::size_t k = g.n();
          g.resize(k + 1);
          g.id[k]           = k;
          g.position[0][k]  = x + (i + 0.5) * d;
          g.position[1][k]  = y + (j + 0.5) * d;
          g.radius[k]       = 0.5 * d;
          g.fluid_radius[k] = 0.4 * d;
        }
  }

  TEST(BedPacking, FullWidth)
  {
    grains::GrainArrays g;
    add_block(g, 0., 0., 40, 30);
    const auto bed = grains::measure_bed(g, 0., 40 * d);
    EXPECT_NEAR(bed.width, 40 * d, 1e-12);
    EXPECT_NEAR(bed.fraction(), M_PI / 4, 1e-9);
    EXPECT_NEAR(bed.fluid_fraction(), 0.64 * M_PI / 4, 1e-9);
  }

  TEST(BedPacking, ColumnInAWideTank)
  {
    for (const unsigned int nx : {9, 17, 20, 31})
      for (const double x : {0., 3.3 * d, 50.7 * d})
        {
          grains::GrainArrays g;
          add_block(g, x, 2 * d, nx, 60);
          const auto bed = grains::measure_bed(g, 0., 103.1 * d);
          EXPECT_NEAR(bed.fraction(), M_PI / 4, 0.03) << nx << ' ' << x;
        }
  }

  TEST(BedPacking, TwoColumns)
  {
    grains::GrainArrays g;
    add_block(g, 0., 0., 24, 40);
    add_block(g, 76 * d, 0., 24, 20);
    add_block(g, 50 * d, 70 * d, 1, 1); // one grain flies
    const auto bed = grains::measure_bed(g, 0., 100 * d);
    EXPECT_NEAR(bed.fraction(), M_PI / 4, 0.02);
    EXPECT_NEAR(bed.width, 48 * d, 2 * d);
  }

  TEST(BedPacking, Heap)
  {
    grains::GrainArrays g;
    for (unsigned int j = 0; j < 30; ++j) // a slope of 1 : 1 on both sides
      add_block(g, (20. + j) * d, j * d, 60 - 2 * j, 1);
    EXPECT_NEAR(grains::measure_bed(g, 0., 100 * d).fraction(), M_PI / 4, 0.07);
  }

  TEST(BedPacking, NoBed)
  {
    grains::GrainArrays g;
    EXPECT_EQ(grains::measure_bed(g, 0., 1.).fraction(), 0.);
    add_block(g, 0.5, 0.5, 1, 1);
    EXPECT_EQ(grains::measure_bed(g, 0., 1.).fraction(), 0.);
  }
} // namespace
