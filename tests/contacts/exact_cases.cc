// Contacts: cases with a closed-form answer that take more than one idea to set up, both sides of every threshold.
#include "silo.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  /** Three discs in a pyramid on the floor, all touching; the largest speed after one step from rest, over g dt. */
  double pyramid_start(const double mu, const double mu_floor)
  {
    constexpr double dt = 1e-4;
    Scene            s;
    s.floor();
    s.exact();
    s.stepper.settings().residual_tolerance  = 1e-10;
    s.stepper.settings().violation_tolerance = 1e-9;
    s.stepper.settings().max_sweeps          = 100000;
    s.stepper.settings().friction            = mu;
    s.stepper.settings().wall_friction       = mu_floor;
    s.add(-r, r);
    s.add(r, r);
    s.add(0., r + std::sqrt(3.) * r);
    s.step(dt);
    EXPECT_EQ(s.report.n_unconverged, 0u);
    return s.report.max_velocity / (g * dt);
  }

  /** Where @p moves changes from true to false between @p low and @p high. */
  template <class Moves>
  double threshold(double low, double high, const Moves &moves)
  {
    for (int k = 0; k < 20; ++k)
      {
        const double middle          = 0.5 * (low + high);
        (moves(middle) ? low : high) = middle;
      }
    return 0.5 * (low + high);
  }

} // namespace


// A block slides if tan a > mu, and only then. One contact is solved exactly, so a billionth either way decides.
TEST(ExactCases, BlockOnInclineThreshold)
{
  for (const double mu : {0.1, 0.4, 1.})
    for (const double off : {-1e-9, 1e-9})
      {
        Scene        s;
        const double a = std::atan(mu) + off, dt = 1e-4;
        s.incline(a);
        s.floor();
        s.exact();
        s.stepper.settings().rotation      = false;
        s.stepper.settings().wall_friction = mu;
        s.add(0., r);
        s.step(dt, 100);
        const double expected = off < 0. ? 0. : (std::sin(a) - mu * std::cos(a)) * g * 100. * dt;
        EXPECT_NEAR(s.grains.velocity[0][0], expected, 1e-14) << mu;
        EXPECT_EQ(s.grains.velocity[0][0] > 1e-11, off > 0.) << mu;
        EXPECT_NEAR(s.report.wall_force["floor"][0] / s.weight(), std::min(std::sin(a), mu * std::cos(a)), 1e-10);
      }
}

// Three balls with gaps that take longer than a step to cross: impacts come one by one, the speeds end as (0, 0, 1).
TEST(ExactCases, CradleWithGaps)
{
  Scene s;
  s.exact();
  s.gy                             = 0.;
  s.stepper.settings().restitution = 1.;
  for (int k = 0; k < 3; ++k)
    s.add(1.1 * k * d, 0., k == 0 ? 1. : 0.);
  s.step(2e-5, 100);
  EXPECT_NEAR(s.grains.velocity[0][0], 0., 1e-14);
  EXPECT_NEAR(s.grains.velocity[0][1], 0., 1e-14);
  EXPECT_NEAR(s.grains.velocity[0][2], 1., 1e-14);
}

// Balls that touch are hit at once, and Newton's law then has another answer than a chain of collisions. Four balls
// with gaps 0, 0, d: the first leaves with -1/3, the other two with 2/3; they meet the last, which leaves with 8/9 and
// them with 2/9. Energy stays the same.
TEST(ExactCases, CradleWithTouchingBalls)
{
  Scene s;
  s.exact();
  s.gy                             = 0.;
  s.stepper.settings().restitution = 1.;
  for (int k = 0; k < 4; ++k)
    s.add((k < 3 ? k : 4) * d, 0., k == 0 ? 1. : 0.);
  const double before = s.kinetic_energy();
  s.step(2e-5);
  EXPECT_NEAR(s.grains.velocity[0][0], -1. / 3., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][1], 2. / 3., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][2], 2. / 3., 1e-10);
  EXPECT_EQ(s.grains.velocity[0][3], 0.);
  s.step(2e-5, 200);
  EXPECT_NEAR(s.grains.velocity[0][0], -1. / 3., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][1], 2. / 9., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][2], 2. / 9., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][3], 8. / 9., 1e-10);
  EXPECT_NEAR(s.kinetic_energy() / before, 1., 1e-10);
}

// The pyramid stands at rest, or starts to spread in its first step: both sides of both thresholds.
TEST(ExactCases, PyramidThresholds)
{
  EXPECT_GT(pyramid_start(0.26, 1.), 1e-3);
  EXPECT_LT(pyramid_start(0.28, 1.), 1e-8);
  EXPECT_GT(pyramid_start(1., 0.085), 1e-3);
  EXPECT_LT(pyramid_start(1., 0.095), 1e-8);

  // The thresholds themselves are 2 - sqrt(3) between discs, and a third of it on the floor.
  const double between = threshold(0.2, 0.3, [](const double mu) { return pyramid_start(mu, 1.) > 1e-7; });
  const double floor   = threshold(0.07, 0.1, [](const double mu) { return pyramid_start(1., mu) > 1e-7; });
  EXPECT_NEAR(between, 2. - std::sqrt(3.), 1e-5);
  EXPECT_NEAR(floor, (2. - std::sqrt(3.)) / 3., 1e-5);
}

// v = v0 - mu g t and r omega = -2 mu g t while it slides, exactly in every step; it has slid 5 v0^2 / (18 mu g) when
// it rolls, and rolls on with 2/3 v0 for ever.
TEST(ExactCases, LaunchedSlidingDisc)
{
  constexpr double mu = 0.3, v0 = 0.1, dt = 1e-5;
  Scene            s;
  s.floor();
  s.exact();
  s.stepper.settings().wall_friction = mu;
  s.add(0., r, v0);
  const double t_roll  = v0 / (3. * mu * g);
  const int    n_slide = static_cast<int>(t_roll / dt);
  for (int k = 1; k <= n_slide; ++k)
    {
      s.step(dt);
      ASSERT_NEAR(s.grains.velocity[0][0], v0 - mu * g * k * dt, 1e-12);
      ASSERT_NEAR(r * s.grains.omega[0], -2. * mu * g * k * dt, 1e-12);
    }
  s.step(dt);
  EXPECT_NEAR(s.grains.velocity[0][0], 2. / 3. * v0, 1e-12);
  EXPECT_NEAR(s.grains.position[0][0], 5. / 18. * v0 * v0 / (mu * g), 2. * v0 * dt);
  s.step(1e-3, 1000);
  EXPECT_NEAR(s.grains.velocity[0][0], 2. / 3. * v0, 1e-10);
  EXPECT_NEAR(r * s.grains.omega[0], -2. / 3. * v0, 1e-10);
  EXPECT_NEAR(s.grains.position[1][0], r, 1e-10 * d);
}

// A gas of discs in a box, far enough apart to meet two at a time: each impact keeps the energy at e = 1 without
// friction, and takes some with e < 1 or friction.
TEST(ExactCases, GasKeepsOrLosesEnergy)
{
  for (const auto &[e, mu] : {std::array<double, 2>{{1., 0.}}, {{0.8, 0.}}, {{1., 0.4}}, {{0.5, 0.4}}})
    {
      Scene s;
      s.exact();
      s.gy                                    = 0.;
      s.stepper.settings().restitution        = e;
      s.stepper.settings().threshold_velocity = 0.;
      s.stepper.settings().friction = s.stepper.settings().wall_friction = mu;
      const double w                                                     = 12. * d;
      s.stepper.set_walls({{{{0., 0.}}, {{w, 0.}}, {{0., 0.}}, "floor"},
                           {{{w, 0.}}, {{w, w}}, {{0., 0.}}, "right"},
                           {{{w, w}}, {{0., w}}, {{0., 0.}}, "top"},
                           {{{0., w}}, {{0., 0.}}, {{0., 0.}}, "left"}});
      for (int k = 0; k < 9; ++k)
        s.add(
          (2. + 4. * (k % 3)) * d, (2. + 4. * (k / 3)) * d, std::sin(7. * k), std::cos(3. * k), r * (1. - 0.02 * k));
      const double start  = s.kinetic_energy();
      double       energy = start;
      for (int k = 0; k < 8000; ++k)
        {
          s.step(1e-5);
          const double now = s.kinetic_energy();
          ASSERT_LE(now, energy * (1. + 1e-11)) << e << ' ' << mu << ' ' << k;
          energy = now;
        }
      if (e == 1. && mu == 0.)
        {
          EXPECT_NEAR(energy / start, 1., 1e-10);
        }
      else
        {
          EXPECT_LT(energy / start, 0.8) << e << ' ' << mu;
        }
    }
}

// Janssen in two dimensions: where the walls carry part, the stress at depth z is s (1 - exp(-z / l)) with
// l = width / (2 mu K) and s = bulk weight * l, K being the ratio of wall pressure to vertical stress. With K and the
// friction used as measured, the floor's force follows, and it saturates while the weight goes on growing.
TEST(ExactCases, JanssenSilo)
{
  constexpr double  mu        = 0.3;
  const int         n_columns = 8;
  std::vector<Silo> silos;
  for (const int n_rows : {12, 24, 48, 96})
    {
      const Silo   silo  = fill_silo(n_columns, n_rows);
      const double width = (n_columns + 0.5) * 1.05 * d, length = width / (2. * mu * silo.mobilised * silo.ratio);
      const double janssen = silo.packing_weight * length * (1. - std::exp(-silo.height / length)) * width;
      EXPECT_GT(silo.mobilised, 0.6) << n_rows;
      EXPECT_LE(silo.mobilised, 1. + 1e-3) << n_rows;
      EXPECT_NEAR(silo.floor / janssen, 1., 0.15) << n_rows;
      silos.push_back(silo);
    }
  // Twice the weight, and the floor hardly feels it.
  for (unsigned int k = 1; k < silos.size(); ++k)
    EXPECT_LT(silos[k].floor / silos[k].weight, 0.9 * silos[k - 1].floor / silos[k - 1].weight);
  EXPECT_LT(silos[3].floor - silos[2].floor, 0.2 * (silos[3].weight - silos[2].weight));
}

// A heavy disc on two light ones: statically determinate, whatever the ratio of their sizes. What is not so is said.
TEST(Boulder, OnTwoGrains)
{
  using namespace alluvium::contacts;
  using namespace alluvium::grains;
  for (const double ratio : {10., 100., 300., 1000.})
    for (const double dt : {1e-3, 1e-4})
      {
        const double small = 1e-4, big = ratio * small, gap = 3. * small;
        test::Scene  scene;
        scene.set("set Friction coefficient = 1\nset Wall friction coefficient = 1");
        scene.floor();
        scene.add(-gap, small, 0., 0., small);
        scene.add(gap, small, 0., 0., small);
        scene.add(0., small + std::sqrt((big + small) * (big + small) - gap * gap), 0., 0., big);
        double weight = 0.;
        for (const double m : scene.grains.mass)
          weight += m * test::g;
        const std::vector<double> y             = scene.grains.position[1];
        unsigned int              n_unconverged = 0;
        for (int step = 0; step < 20; ++step)
          {
            scene.step(dt);
            double carried = 0.;
            for (const auto &[name, force] : scene.report.wall_force)
              carried -= force[1];
            n_unconverged += scene.report.n_unconverged;
            EXPECT_NEAR(carried / weight, 1., 0.03) << "ratio " << ratio << ", dt " << dt << ", step " << step;
          }
        if (ratio <= 300.)
          {
            EXPECT_EQ(n_unconverged, 0u) << "ratio " << ratio << ", dt " << dt;
          }
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(scene.grains.position[1][k], y[k], 0.02 * small) << "ratio " << ratio << ", dt " << dt;
      }
}
