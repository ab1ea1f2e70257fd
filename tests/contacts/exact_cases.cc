// Contacts: cases with a closed-form answer that take more than one idea to set up, both sides of every threshold.
#include "contact_scene.h"

#include <alluvium/utilities/random_numbers.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

using alluvium::RandomNumbers;
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

  /** What the walls of a silo carry, layer by layer, while its floor gives way. */
  struct Silo
  {
    double              height = 0., weight = 0., floor = 0., mobilised = 0., ratio = 0., packing_weight = 0.;
    std::vector<double> vertical; // mean vertical stress at the middle of each layer, from the top [N/m^2]
  };

  /**
   * Discs in a silo of width @p width, filled to about @p n_rows rows, whose floor sinks slowly, so that the discs slip
   * down along the walls and friction is fully used. Means over the time in which the floor sinks by d / 2.
   */
  Silo fill_silo(const int n_columns, const int n_rows)
  {
    const double     width = (n_columns + 0.5) * 1.05 * d, top = 2. * n_rows * d;
    constexpr int    layers = 6;
    constexpr double mu     = 0.3;
    Scene            s;
    s.stepper.settings().friction      = 0.5;
    s.stepper.settings().wall_friction = mu;
    RandomNumbers random(n_rows);
    for (int row = 0; row < n_rows; ++row)
      for (int column = 0; column < n_columns; ++column)
        s.add((column + 0.5 + 0.5 * (row % 2)) * 1.05 * d, r + row * 0.92 * d, 0., 0., r * random.uniform(0.7, 1.));

    // Side walls in pieces, to see the force on each.
    const auto set_walls = [&](const double bottom, const double filled, const double sinking) {
      std::vector<WallSegment> walls{{{{0., bottom}}, {{width, bottom}}, {{0., -sinking}}, "floor"}};
      for (int k = 0; k <= layers; ++k)
        for (int side = 0; side < 2; ++side)
          {
            const double x = side * width, low = k == 0 ? bottom - 5. * d : bottom + k * filled / layers,
                         high = k == layers ? top : bottom + (k + 1) * filled / layers;
            walls.push_back(
              {{{x, low}}, {{x, high}}, {{0., 0.}}, (side == 0 ? "left " : "right ") + std::to_string(k)});
          }
      s.stepper.set_walls(walls);
    };
    const auto filled = [&] {
      double y = 0.;
      for (std::size_t k = 0; k < s.grains.n(); ++k)
        y = std::max(y, s.grains.position[1][k] + s.grains.radius[k]);
      return y;
    };
    set_walls(0., filled(), 0.);
    const double dt = 0.1 * std::sqrt(d / g);
    for (int k = 0; k < 300; ++k)
      {
        s.loads.drag.resize(s.grains.n());
        for (std::size_t i = 0; i < s.grains.n(); ++i)
          s.loads.drag[i] = k < 250 ? 0.2 * s.grains.mass[i] / dt : 0.;
        s.step(dt);
      }

    const double sinking = 5e-3 * std::sqrt(g * d);
    Silo         silo;
    silo.height = filled();
    silo.weight = s.weight();
    set_walls(0., silo.height, sinking);
    std::vector<std::array<double, 2>> wall(layers + 1, {{0., 0.}}); // normal and vertical force of both sides
    const int                          run_up  = static_cast<int>(0.5 * d / (sinking * dt));
    const int                          measure = run_up;
    for (int k = 0; k < run_up + measure; ++k)
      {
        s.step(dt);
        if (k < run_up)
          continue;
        silo.floor -= s.report.wall_force["floor"][1] / measure;
        for (int l = 0; l <= layers; ++l)
          {
            const auto left  = s.report.wall_force["left " + std::to_string(l)],
                       right = s.report.wall_force["right " + std::to_string(l)];
            wall[l][0] += (right[0] - left[0]) / measure;
            wall[l][1] -= (left[1] + right[1]) / measure;
          }
      }
    double normal = 0., vertical = 0.;
    for (const auto &w : wall)
      {
        normal += w[0];
        vertical += w[1];
      }
    silo.mobilised = vertical / (mu * normal);

    // Vertical stress from above: weight less what the walls took; then the ratio of wall pressure to it.
    double       stress_sum = 0., pressure_sum = 0., carried = 0.;
    const double layer = silo.height / layers;
    for (int l = layers; l >= 0; --l)
      {
        double above = 0.;
        for (std::size_t k = 0; k < s.grains.n(); ++k)
          if (s.grains.position[1][k] > (l + 0.5) * layer)
            above += s.grains.mass[k] * g;
        if (l < layers)
          {
            const double stress = (above - carried - 0.5 * wall[l][1]) / width;
            silo.vertical.push_back(stress);
            stress_sum += stress;
            pressure_sum += 0.5 * wall[l][0] / layer;
          }
        carried += wall[l][1];
      }
    silo.ratio          = pressure_sum / stress_sum;
    silo.packing_weight = silo.weight / (width * silo.height); // bulk weight [N/m^3]
    return silo;
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
TEST(ExactCases, BoulderOnTwoGrains)
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
