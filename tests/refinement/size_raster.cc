#include <alluvium/refinement/size_raster.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{
  using namespace alluvium::mesh;
  using namespace alluvium::refinement;

  const Box domain{{{0., 0.}}, {{1., 2.}}};

  double at(const SizeRaster &raster, const double x, const double y)
  {
    return raster.smallest_in({{{x, y}}, {{x, y}}});
  }

  TEST(SizeRaster, SizesGrowWithTheDistanceFromTheNearestStamp)
  {
    const double side = 0.01, growth = 0.5;
    SizeRaster   raster;
    raster.reinit(domain, {{false, false}}, side);
    raster.stamp({{{0.5, 1.}}, {{0.5, 1.}}}, 0.02);
    raster.stamp({{{0.9, 0.1}}, {{0.95, 0.15}}}, 0.1);
    raster.spread(MPI_COMM_SELF, growth);
    for (double x = 0.005; x < 1.; x += 0.1)
      for (double y = 0.005; y < 2.; y += 0.1)
        {
          const double dx = std::max({0., 0.9 - x, x - 0.95}), dy = std::max({0., 0.1 - y, y - 0.15});
          const double exact = std::min(0.02 + growth * std::hypot(x - 0.5, y - 1.), 0.1 + growth * std::hypot(dx, dy));
          // eight directions instead of all make distances up to 8.3 % longer; a bucket is a bucket
          EXPECT_GT(at(raster, x, y), exact - 1.5 * growth * side) << x << ' ' << y;
          EXPECT_LT(at(raster, x, y), 1.083 * exact + 1.5 * growth * side) << x << ' ' << y;
        }
    // a larger box never has a larger size
    EXPECT_LE(raster.smallest_in(widened({{{0.2, 0.2}}, {{0.3, 0.3}}}, 0.1)),
              raster.smallest_in({{{0.2, 0.2}}, {{0.3, 0.3}}}));
  }

  TEST(SizeRaster, AMirroredDomainHasMirroredSizes)
  {
    // a width that is no multiple of the buckets'
    const Box  box{{{0., 0.}}, {{1.037, 2.}}};
    SizeRaster raster, mirrored;
    raster.reinit(box, {{false, false}}, 0.1);
    mirrored.reinit(box, {{false, false}}, 0.1);
    raster.stamp({{{0.2, 0.5}}, {{0.33, 0.6}}}, 0.02);
    mirrored.stamp({{{1.037 - 0.33, 0.5}}, {{1.037 - 0.2, 0.6}}}, 0.02);
    raster.spread(MPI_COMM_SELF, 0.5);
    mirrored.spread(MPI_COMM_SELF, 0.5);
    for (double x = 0.01; x < 1.037; x += 0.03)
      EXPECT_NEAR(at(raster, x, 0.55), at(mirrored, 1.037 - x, 0.55), 1e-12) << x;
  }

  TEST(SizeRaster, WithoutStampsThereIsNoWish)
  {
    SizeRaster raster;
    raster.reinit(domain, {{false, false}}, 0.01);
    raster.stamp({{{-1., -1.}}, {{-0.5, 3.}}}, 0.01); // outside
    raster.spread(MPI_COMM_SELF, 0.5);
    EXPECT_TRUE(std::isinf(raster.smallest_in(domain)));
  }

  TEST(SizeRaster, WishesGoOverSeams)
  {
    SizeRaster raster;
    raster.reinit(domain, {{true, false}}, 0.01);
    raster.stamp(widened({{{0.98, 1.}}, {{0.98, 1.}}}, 0.05), 0.02);
    raster.spread(MPI_COMM_SELF, 0.5);
    EXPECT_EQ(at(raster, 0.015, 1.), 0.02);
    EXPECT_NEAR(at(raster, 0.135, 1.), 0.02 + 0.5 * 0.105, 0.01);
    EXPECT_GT(at(raster, 0.135, 0.2), 0.3); // not over the ends in y
  }
} // namespace
