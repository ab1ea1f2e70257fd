#include <alluvium/run/kinks.h>
#include <alluvium/run/pi_controller.h>
#include <alluvium/run/poles.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace alluvium::run;

namespace
{
  /** What backward Euler leaves of u' = -k (u - cos t), u(0) = 0, at t = 10, with steps chosen for @p tolerance. */
  struct Decay
  {
    double       error   = 0.;
    unsigned int n_steps = 0, n_taken_back = 0;

    Decay(const double k, const double tolerance)
    {
      PiController controller;
      double       t = 0., u = 0., change = 0., dt_before = 0., dt = 1e-4 * std::sqrt(tolerance);
      while (t < 10.)
        {
          dt                 = std::min(dt, 10. - t);
          const double next  = (u + dt * k * std::cos(t + dt)) / (1. + dt * k);
          const double ratio = dt_before > 0. ? dt / dt_before : 0.;
          const double local =
            dt_before > 0. ? dt / (dt + dt_before) * std::abs(next - u - ratio * change) / tolerance : 0.;
          if (local > 1.)
            {
              dt *= PiController::taken_back(local);
              ++n_taken_back;
              continue;
            }
          change    = next - u;
          dt_before = dt;
          t += dt;
          u = next;
          ++n_steps;
          dt *= controller.accepted(local);
        }
      // without the fast part, which has gone
      error = std::abs(u - k * (k * std::cos(10.) + std::sin(10.)) / (1. + k * k));
    }
  };
} // namespace

TEST(PiController, ErrorFollowsTheToleranceAndStepsItsRoot)
{
  Decay before(20., 1e-3);
  for (const double tolerance : {1e-4, 1e-5, 1e-6})
    {
      const Decay now(20., tolerance);
      // of first order: the error left goes with the length of steps, the root of what one of them may be wrong by
      EXPECT_NEAR(before.error / now.error, std::sqrt(10.), 1.);
      EXPECT_NEAR(double(now.n_steps) / before.n_steps, std::sqrt(10.), 1.); // a first-order method
      EXPECT_LT(now.n_taken_back, 0.05 * now.n_steps + 3.);
      before = now;
    }
}

TEST(PiController, AStiffPartThatHasGoneCostsNothing)
{
  EXPECT_LT(Decay(1e6, 1e-3).n_steps, 1.5 * Decay(20., 1e-3).n_steps);
}

TEST(PiController, OfAnErrorThatIsNotFiniteTheStepShrinksMost)
{
  for (const double error : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(PiController::taken_back(error), PiController::least_factor);
}

TEST(Kinks, OfAFunctionAreFoundToRoundOff)
{
  const auto ramp  = [](const double t) { return t < 0.2 ? 0. : std::min(1., (t - 0.2) / 0.3); };
  const auto found = find_kinks(ramp, 0., 1.);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], 0.2, 1e-9);
  EXPECT_NEAR(found[1], 0.5, 1e-9);
}

TEST(Kinks, OfAJumpTheTimeIsTheLastBeforeIt)
{
  for (const double at : {0.123456789, 0.5, 0.7})
    {
      const auto found = find_kinks([at](const double t) { return t < at ? 1. : 3.; }, 0., 1.);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_LT(found[0], at);
      EXPECT_NEAR(found[0], at, 1e-15);
      const auto open = find_kinks([at](const double t) { return t <= at ? 1. : 3.; }, 0., 1.);
      ASSERT_EQ(open.size(), 1u);
      EXPECT_NEAR(open[0], at, 1e-15);
    }
}

TEST(Kinks, SmoothFunctionsHaveNone)
{
  for (const double frequency : {1., 10., 100., 1000.})
    EXPECT_TRUE(find_kinks([frequency](const double t) { return std::sin(frequency * t); }, 0., 10.).empty())
      << frequency;
  EXPECT_TRUE(find_kinks([](const double t) { return 103e3 + 200. * t + 5e3 * t * t; }, 0., 1.).empty());
  EXPECT_TRUE(find_kinks([](const double) { return 103e3; }, 0., 1.).empty());
}

TEST(Kinks, OnlyThoseBetweenTheEndsAndNotHundreds)
{
  const auto steps = [](const double t) { return std::floor(1e-9 + t); };
  EXPECT_EQ(find_kinks(steps, 0., 4.5).size(), 4u);
  const auto many = [](const double t) { return std::floor(1000. * t); };
  EXPECT_TRUE(find_kinks(many, 0., 1.).empty());
}

TEST(Kinks, AbsoluteValueAndSquarePulses)
{
  const auto found = find_kinks([](const double t) { return std::abs(std::sin(3. * t)); }, 0., 2.5);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], M_PI / 3., 1e-9);
  EXPECT_NEAR(found[1], 2. * M_PI / 3., 1e-9);
  const auto pulse = find_kinks([](const double t) { return t > 0.3 && t < 0.301 ? 1e5 : 0.; }, 0., 1.);
  ASSERT_EQ(pulse.size(), 2u);
  EXPECT_NEAR(pulse[0], 0.3, 1e-12);
  EXPECT_NEAR(pulse[1], 0.301, 1e-12);
}


namespace
{
  std::vector<double> even_times(const double end, const unsigned int n)
  {
    std::vector<double> times;
    for (unsigned int i = 0; i <= n; ++i)
      times.push_back(i * end / n);
    return times;
  }
} // namespace

TEST(Poles, AreFoundBetweenTheTimesThatAreLookedAt)
{
  using Function                                          = std::function<double(double)>;
  const std::vector<std::pair<Function, double>> with_one = {
    {[](const double t) { return 1. / (0.01234567 - t); }, 0.01234567},
    {[](const double t) { return 3. + 1e-3 / (t - 0.0100001); }, 0.0100001},
    {[](const double t) { return 1. / ((t - 0.0123) * (t - 0.0123)); }, 0.0123}, // at a time that is looked at, about
    {[](const double t) { return std::tan(M_PI / 2. * t / 0.0171); }, 0.0171},
    {[](const double t) { return 1. / std::sqrt(std::abs(t - M_PI / 300.)); }, M_PI / 300.},
    {[](const double t) { return 1. / t; }, 0.},
    {[](const double t) { return 1. / (0.02 - t); }, 0.02},
    {[](const double t) { return std::sqrt(0.015 - t); }, 0.015},
  };
  for (const unsigned int n : {20u, 1000u})
    for (std::size_t i = 0; i < with_one.size(); ++i)
      {
        const auto pole = find_pole(with_one[i].first, even_times(0.02, n));
        ASSERT_TRUE(pole) << i << " with " << n;
        EXPECT_NEAR(pole->time, with_one[i].second, 1.001 * 0.02 / n) << i << " with " << n;
      }
}

TEST(Poles, AreNotSeenWhereThereAreNone)
{
  using Function                      = std::function<double(double)>;
  const std::vector<Function> without = {
    [](const double) { return 0.; },
    [](const double t) { return t < 0.0101 ? 0. : 1e6; },                              // a jump
    [](const double t) { return std::exp(-std::pow((t - 0.0101) / 1e-7, 2)); },        // a pulse that is hardly seen
    [](const double t) { return 1. / ((t - 0.0101) * (t - 0.0101) + 1e-12); },         // near to a pole
    [](const double t) { return 1. / (0.0200001 - t); },                               // after the end
    [](const double t) { return std::sin(1e5 * t) + std::abs(std::sin(3e3 * t)); },    // many peaks and kinks
    [](const double t) { return std::exp(1e3 * t); },                                  // steep
    [](const double t) { return std::fmod(43758.5453 * std::sin(1e7 * t + 12.), 1.); } // noise
  };
  for (const unsigned int n : {20u, 1000u})
    for (std::size_t i = 0; i < without.size(); ++i)
      EXPECT_FALSE(find_pole(without[i], even_times(0.02, n))) << i << " with " << n;
}
