// What contact solvers are made of: sums that do not depend on their order, colours, and how they agree.
#include <alluvium/grains/reproducible_sum.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace alluvium::grains;

TEST(ReproducibleSum, DoesNotDependOnTheOrder)
{
  std::mt19937_64     random(3);
  std::vector<double> terms(10000);
  double              plain = 0., bound = 0.;
  for (double &t : terms)
    {
      t = std::exp(-30. * (random() >> 11) * 0x1p-53) * ((random() & 1) ? 1. : -1.);
      bound += std::abs(t);
    }
  std::vector<double> totals, plain_totals;
  for (int order = 0; order < 20; ++order)
    {
      std::shuffle(terms.begin(), terms.end(), random);
      ReproducibleSum sum(bound);
      plain = 0.;
      for (const double t : terms)
        {
          sum.add(t);
          plain += t;
        }
      totals.push_back(sum.value());
      plain_totals.push_back(plain);
    }
  EXPECT_EQ(std::count(totals.begin(), totals.end(), totals[0]), 20);
  EXPECT_LT(std::count(plain_totals.begin(), plain_totals.end(), plain_totals[0]), 20); // or the test shows nothing
  EXPECT_NEAR(totals[0], plain, 1e4 * 0x1p-50 * bound);
}

// Sums of sums, as over ranks, are the sum; also when the parts are cut elsewhere.
TEST(ReproducibleSum, PartsAddUp)
{
  std::mt19937_64     random(5);
  std::vector<double> terms(1000);
  for (double &t : terms)
    t = std::exp(-10. * (random() >> 11) * 0x1p-53);
  ReproducibleSum whole(1000.);
  for (const double t : terms)
    whole.add(t);
  for (const std::size_t cut : {1, 77, 500, 999})
    {
      ReproducibleSum a(1000.), b(1000.);
      for (std::size_t k = 0; k < terms.size(); ++k)
        (k < cut ? a : b).add(terms[k]);
      EXPECT_EQ(a.value() + b.value(), whole.value());
    }
}

// Whether a sum of positive terms outgrew its bound is known, in any order.
TEST(ReproducibleSum, KnowsWhenTheBoundWasTooSmall)
{
  std::vector<double> terms(100, 1.);
  terms[0] = 1e-9;
  terms[1] = 40.;
  for (int order = 0; order < 100; ++order)
    {
      std::rotate(terms.begin(), terms.begin() + 1, terms.end());
      ReproducibleSum small(100.), large(200.);
      for (const double t : terms)
        {
          small.add(t);
          large.add(t);
        }
      EXPECT_FALSE(small.holds());
      EXPECT_TRUE(large.holds());
    }
  ReproducibleSum sum(1.);
  sum.add(std::nan(""));
  EXPECT_FALSE(sum.holds());
}
