// The contact step against exact answers.
#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include <cmath>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  /** A column of discs, loosely stacked in a hexagonal pile with some disorder. */
  void add_column(Scene &scene, const int n_columns, const int n_rows)
  {
    for (int row = 0; row < n_rows; ++row)
      for (int column = 0; column < n_columns; ++column)
        {
          const double disorder = 0.02 * d * std::sin(12.9898 * row + 78.233 * column);
          scene.add((column + 0.5 * (row % 2)) * 1.05 * d + disorder,
                    r + row * 0.95 * d,
                    0.,
                    0.,
                    r * (0.95 + 0.04 * std::sin(5. * row + column)));
        }
  }
} // namespace


// Each impact turns the speed around, times e: exactly, if nothing else acts.
TEST(Contacts, BounceBetweenWalls)
{
  Scene s;
  s.gy                             = 0.;
  s.stepper.settings().restitution = 0.8;
  s.stepper.set_walls(
    {{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}, {{{-1., 5 * d}}, {{1., 5 * d}}, {{0., 0.}}, "lid"}});
  s.add(0., 2 * d, 0., -1.);
  int    bounces = 0;
  double speed   = 1.;
  for (int k = 0; k < 300; ++k)
    {
      s.step(1e-4);
      if (std::abs(std::abs(s.grains.velocity[1][0]) - speed) > 1e-12)
        {
          ++bounces;
          speed *= 0.8;
        }
      ASSERT_NEAR(std::abs(s.grains.velocity[1][0]), speed, 1e-12);
    }
  EXPECT_GE(bounces, 4);
}

// Under gravity the heights are e^{2k} h0 up to the order of time stepping, which is one.
TEST(Contacts, BounceUnderGravityConverges)
{
  double errors[2];
  for (int level = 0; level < 2; ++level)
    {
      Scene s;
      s.floor();
      s.stepper.settings().restitution = 0.7;
      const double h0 = 0.1, dt = level == 0 ? 1e-4 : 2.5e-5;
      s.add(0., r + h0);
      double top = 0.;
      bool   up  = false;
      for (double t = 0.; t < 2. * std::sqrt(2. * h0 / g) * 1.1; t += dt)
        {
          s.step(dt);
          up  = up || s.grains.velocity[1][0] > 0.;
          top = up ? std::max(top, s.grains.position[1][0] - r) : top;
        }
      errors[level] = std::abs(top / h0 - 0.49);
    }
  EXPECT_LT(errors[0], 1e-2);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
}

TEST(Contacts, BlockOnIncline)
{
  for (const double degrees : {20., 30.})
    {
      Scene        s;
      const double a = degrees * M_PI / 180., mu = 0.4;
      s.gx = g * std::sin(a);
      s.gy = -g * std::cos(a);
      s.floor();
      s.exact();
      s.stepper.settings().rotation = false;
      s.add(0., r);
      s.step(1e-4, 100);
      // tan 20 < 0.4 < tan 30
      const double expected = std::max(0., std::sin(a) - mu * std::cos(a)) * g * 1e-2;
      EXPECT_NEAR(s.grains.velocity[0][0], expected, 1e-10);
      EXPECT_EQ(s.grains.omega[0], 0.);
    }
}

// A disc rolls with 2/3 g sin a until tan a = 3 mu (50.19 degrees at mu = 0.4); then it slips.
TEST(Contacts, DiscOnIncline)
{
  for (const double degrees : {10., 30., 50., 50.4, 60.})
    {
      Scene        s;
      const double a = degrees * M_PI / 180., mu = 0.4;
      s.gx = g * std::sin(a);
      s.gy = -g * std::cos(a);
      s.floor();
      s.exact();
      s.add(0., r);
      s.step(1e-4, 100);
      const bool   rolls    = std::tan(a) < 3. * mu;
      const double expected = (rolls ? 2. / 3. * std::sin(a) : std::sin(a) - mu * std::cos(a)) * g * 1e-2;
      EXPECT_NEAR(s.grains.velocity[0][0], expected, 1e-10) << degrees;
      const double slip = s.grains.velocity[0][0] + r * s.grains.omega[0];
      EXPECT_EQ(slip > 1e-5, !rolls);
      EXPECT_LT(rolls ? std::abs(slip) : 0., 1e-10);
    }
}

TEST(Contacts, LaunchedDiscRollsAtTwoThirds)
{
  Scene s;
  s.floor();
  s.exact();
  const double v0 = 0.1, mu = 0.4, dt = 1e-5, t_roll = v0 / (3. * mu * g);
  s.add(0., r, v0);
  double t = 0.;
  while (s.grains.velocity[0][0] + r * s.grains.omega[0] > 1e-9 && t < 1.)
    {
      s.step(dt);
      t += dt;
    }
  EXPECT_NEAR(t, t_roll, 1.01 * dt);
  EXPECT_NEAR(s.grains.velocity[0][0], 2. / 3. * v0, 1e-10);
  EXPECT_NEAR(s.grains.omega[0], -2. / 3. * v0 / r, 1e-6);
}

// Disc k of a stack carries all above it.
TEST(Contacts, Stack)
{
  const int n = 20;
  Scene     s;
  s.floor();
  s.exact();
  for (int k = 0; k < n; ++k)
    s.add(0., r + k * d);
  s.step(1e-4);
  const double mg = s.grains.mass[0] * g;
  EXPECT_NEAR(s.report.wall_force["floor"][1] / (-n * mg), 1., 1e-9);
  for (const auto &e : s.stepper.archive().entries)
    if (!e.wall)
      {
        const double above = n - 1 - (e.a - 3.) / 10.;
        EXPECT_NEAR(e.rn / 1e-4 / mg, above, 1e-8);
      }
  for (std::size_t k = 0; k < s.grains.n(); ++k)
    {
      EXPECT_NEAR(s.grains.contact_force[1][k] / mg, 1., 1e-8);
      EXPECT_TRUE(s.stepper.touched()[k]);
    }
}

// In a stack, grain k from the top carries k weights below it and k - 1 above: r (x) f over the area.
TEST(Contacts, StressOfAStack)
{
  const int n = 10;
  Scene     s;
  s.floor();
  s.exact();
  for (int k = 0; k < n; ++k)
    s.add(0., r + k * d);
  s.step(1e-4);
  const double mg     = s.grains.mass[0] * g;
  const auto   forces = s.stepper.forces(s.grains);
  ASSERT_EQ(forces.size(), static_cast<std::size_t>(n));
  for (const ContactForce &f : forces)
    {
      EXPECT_NEAR(f.normal / mg, n - (f.wall ? 0. : std::max(f.i, f.j)), 1e-8);
      EXPECT_NEAR(f.tangential / mg, 0., 1e-8);
      EXPECT_NEAR(f.length / r, f.wall ? 1. : 2., 1e-8);
    }
  const auto stress = grain_stresses(s.grains, forces);
  for (int k = 0; k < n; ++k)
    {
      const double below = n - k, above = below - 1.;
      EXPECT_NEAR(stress[k][3] / (-(below + above) * mg * r / (M_PI * r * r)), 1., 1e-8);
      EXPECT_NEAR(stress[k][0] / (mg / r), 0., 1e-8);
      EXPECT_NEAR(stress[k][1] / (mg / r), 0., 1e-8);
    }
}

// With gaps that take longer than a step to cross, impacts come one after the other and the last ball leaves with all
// the speed.
TEST(Contacts, NewtonsCradle)
{
  Scene s;
  s.gy                             = 0.;
  s.stepper.settings().restitution = 1.;
  for (int k = 0; k < 5; ++k)
    s.add(k * 1.1 * d, 0., k == 0 ? 1. : 0.);
  s.step(2e-5, 100);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(s.grains.velocity[0][k], 0., 1e-10);
  EXPECT_NEAR(s.grains.velocity[0][4], 1., 1e-10);
}

// Three discs in a pyramid stand if mu between them is at least 2 - sqrt(3) = 0.2679 and with the ground a third of
// that.
TEST(Contacts, Pyramid)
{
  for (const auto &[mu, mu_ground, stands] : {std::make_tuple(0.26, 0.5, false),
                                              std::make_tuple(0.28, 0.5, true),
                                              std::make_tuple(0.5, 0.085, false),
                                              std::make_tuple(0.5, 0.095, true)})
    {
      Scene s;
      s.floor();
      s.exact();
      s.stepper.settings().residual_tolerance = 1e-8;
      s.stepper.settings().friction           = mu;
      s.stepper.settings().wall_friction      = mu_ground;
      s.add(-r, r);
      s.add(r, r);
      s.add(0., r + std::sqrt(3.) * r);
      const double top = s.grains.position[1][2];
      s.step(1e-4, 1000);
      const double sunk = (top - s.grains.position[1][2]) / d;
      if (stands)
        {
          EXPECT_LT(std::abs(sunk), 1e-4) << mu << ' ' << mu_ground;
        }
      else
        {
          EXPECT_GT(sunk, 1e-2) << mu << ' ' << mu_ground;
        }
    }
}

// v_free = (m v + h f) / (m + h G), contact impulses act on m + h G, and a resting disc's contact force is its weight.
TEST(Contacts, EffectiveMass)
{
  Scene s;
  s.exact();
  s.floor();
  s.add(0., 10. * d, 0.3, 0.2);
  s.add(5. * d, r);
  const double dt = 1e-4;
  s.loads.drag    = {3e3 * s.grains.mass[0], 7e3 * s.grains.mass[1]};
  s.step(dt);
  EXPECT_NEAR(s.grains.velocity[0][0], 0.3 / 1.3, 1e-14);
  EXPECT_NEAR(s.grains.velocity[1][0], (0.2 - dt * g) / 1.3, 1e-14);
  EXPECT_NEAR(s.grains.velocity[1][1], 0., 1e-12);
  EXPECT_NEAR(s.grains.contact_force[1][1] / (s.grains.mass[1] * g), 1., 1e-10);
  EXPECT_EQ(s.grains.contact_force[1][0], 0.);

  // Two discs meet without bouncing: they go on with the mean of their free velocities, weighted with the effective
  // masses.
  Scene p;
  p.exact();
  p.gy = 0.;
  p.add(0., 0., 0.01);
  p.add(d, 0., -0.02);
  p.loads.drag = {1e3 * p.grains.mass[0], 9e3 * p.grains.mass[1]};
  p.step(dt);
  EXPECT_NEAR(p.grains.velocity[0][0], (0.01 - 0.02) / (1.1 + 1.9), 1e-13);
  EXPECT_NEAR(p.grains.velocity[0][1], p.grains.velocity[0][0], 1e-13);
}

TEST(Contacts, InfiniteMassStaysPut)
{
  Scene s;
  s.exact();
  s.add(0., 0.);
  s.grains.mass[0] = std::numeric_limits<double>::infinity();
  s.add(0., d);
  s.loads.drag = {0., 0.};
  for (int k = 0; k < 10; ++k)
    {
      s.loads.force[0] = {0., 0.};
      s.loads.force[1] = {0., -g * s.grains.mass[1]};
      s.stepper.advance(s.grains, s.loads, 1e-4, {{0., -g}});
    }
  EXPECT_EQ(s.grains.velocity[1][0], 0.);
  EXPECT_NEAR(s.grains.velocity[1][1], 0., 1e-12);
}

TEST(Contacts, MovingWalls)
{
  // A belt drags a disc along: it slips, and what friction gives is mu g.
  Scene belt;
  belt.exact();
  belt.floor({{1., 0.}});
  belt.add(0., r);
  belt.step(1e-4, 10);
  EXPECT_NEAR(belt.grains.velocity[0][0], 0.4 * g * 1e-3, 1e-12);
  EXPECT_EQ(belt.stepper.walls()[0].a[0], -1.);
  // A piston lifts one.
  Scene piston;
  piston.exact();
  piston.floor({{0., 0.1}});
  piston.add(0., r);
  piston.step(1e-4, 10);
  EXPECT_NEAR(piston.grains.velocity[1][0], 0.1, 1e-12);
  EXPECT_NEAR(piston.grains.position[1][0], r + 1e-4, 1e-12);
  EXPECT_NEAR(piston.stepper.walls()[0].a[1], 1e-4, 1e-15);
}

/** How many of @p walls a disc of radius 0.1 at (@p x, @p y) touches. */
static int n_touched(const WallGeometry &walls, const double x, const double y)
{
  int          n = 0;
  ContactPoint p;
  for (std::size_t k = 0; k < walls.segments().size(); ++k)
    n += walls.touch(k, x, y, 0.1, p) && p.gap < 0.01;
  return n;
}

TEST(Contacts, CornersCountOnce)
{
  WallGeometry walls;
  walls.set({{{{0., 0.}}, {{1., 0.}}, {{0., 0.}}, "a"},
             {{{1., 0.}}, {{1., 1.}}, {{0., 0.}}, "b"},
             {{{1., 1.}}, {{2., 1.}}, {{0., 0.}}, "c"},
             {{{2., 1.}}, {{3., 1.}}, {{0., 0.}}, "d"}});
  const auto count = [&](const double x, const double y) { return n_touched(walls, x, y); };
  EXPECT_EQ(count(0.9, 0.1), 2);   // inside a corner: two walls
  EXPECT_EQ(count(0.93, 1.07), 1); // around the outer corner of b and c: their shared end, once
  EXPECT_EQ(count(2., 1.1), 1);    // on the joint of two segments in line
  EXPECT_EQ(count(1.99, 1.1), 1);  // and near it
  EXPECT_EQ(count(2.01, 1.1), 1);
  EXPECT_EQ(count(3.05, 1.05), 1); // at a free end
  EXPECT_EQ(count(3.15, 1.), 0);

  // A disc that rests on a joint feels its weight once.
  Scene s;
  s.exact();
  s.stepper.set_walls({{{{-1., 0.}}, {{0., 0.}}, {{0., 0.}}, "left"}, {{{0., 0.}}, {{1., 0.}}, {{0., 0.}}, "right"}});
  s.add(0., r);
  s.step(1e-4);
  EXPECT_EQ(s.report.n_contacts, 1u);
  EXPECT_NEAR(s.report.wall_force["left"][1] / -s.weight(), 1., 1e-10);
}

TEST(Contacts, WallsThatLieOnOneAnotherCountOnce)
{
  WallGeometry walls;
  const auto   count = [&](const double x, const double y) { return n_touched(walls, x, y); };
  const auto   at    = [](const double ax, const double ay, const double bx, const double by) {
    return WallSegment{{{ax, ay}}, {{bx, by}}, {{0., 0.}}, "w"};
  };
  // both faces of a crack
  walls.set({at(0., 0., 1., 0.), at(1., 0., 0., 0.)});
  for (const double x : {-0.05, 0., 0.5, 1., 1.05})
    for (const double y : {-0.1, -0.05, 0.05, 0.1})
      EXPECT_EQ(count(x, y), std::abs(y) < 0.1 || (x >= 0. && x <= 1.)) << x << ' ' << y;
  // a part in common
  walls.set({at(0., 0., 1., 0.), at(0.6, 0., 2., 0.)});
  for (const double x : {0.1, 0.6, 0.8, 1., 1.5, 2.})
    EXPECT_EQ(count(x, 0.1), 1) << x;
  // one inside the other
  walls.set({at(0.4, 0., 0.6, 0.), at(0., 0., 1., 0.)});
  for (const double x : {0.1, 0.4, 0.5, 0.6, 0.9})
    EXPECT_EQ(count(x, 0.1), 1) << x;
  // one ends on the middle of the other: once below it, twice in its corners
  walls.set({at(0., 0., 1., 0.), at(0.5, 0., 0.5, 1.)});
  EXPECT_EQ(count(0.5, -0.1), 1);
  EXPECT_EQ(count(0.45, -0.1), 1);
  EXPECT_EQ(count(0.4, 0.1), 2);
  EXPECT_EQ(count(0.5, 1.05), 1);
  // beside each other
  walls.set({at(0., 0., 1., 0.), at(0., 0.2, 1., 0.2)});
  EXPECT_EQ(count(0.5, 0.1), 2);
}

TEST(Contacts, EnergyNeverGrows)
{
  Scene s;
  s.floor();
  add_column(s, 8, 20);
  double energy = s.energy();
  s.step(2e-4);
  for (int k = 0; k < 400; ++k)
    {
      s.step(2e-4);
      const double now = s.energy();
      ASSERT_LE(now, energy + 1e-6 * s.weight() * d) << k;
      energy = now;
      ASSERT_LT(s.report.max_penetration, 0.15 * d);
      ASSERT_EQ(s.report.n_unconverged, 0u);
    }
}

TEST(Contacts, OverlapsOpenSlowly)
{
  Scene s;
  s.floor();
  s.add(0., 0.8 * r);
  s.add(0., 1.9 * r);
  const double e0 = s.energy(), limit = s.stepper.settings().depenetration_speed * std::sqrt(g * d);
  double       fastest = 0.;
  for (int k = 0; k < 3000; ++k)
    {
      s.step(1e-4);
      fastest = std::max(fastest, s.report.max_velocity);
    }
  EXPECT_LT(fastest, 3. * limit);
  EXPECT_LT(s.report.max_penetration, 1e-3 * d);
  EXPECT_LT(s.energy(), e0 + s.weight() * d);
  EXPECT_GE(s.grains.position[1][0], 0.999 * r);
}

TEST(Contacts, OverlapsAreFound)
{
  Scene s;
  s.add(0., r);
  s.add(0.9 * d, r);
  s.add(5. * d, 0.9 * r);
  const std::vector<WallSegment> walls{{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}};
  const auto                     found = find_overlaps(s.grains, walls, 1e-6 * d);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].depth, 0.1 * d, 1e-15);
  EXPECT_EQ(found[0].b, 13u);
  EXPECT_EQ(found[1].wall, "floor");
  EXPECT_THROW(check_overlaps(s.grains, walls, 1e-6 * d), UserError);
  EXPECT_NO_THROW(check_overlaps(s.grains, walls, 0.2 * d));
}

TEST(Contacts, RepeatsBitByBitAlsoAfterARestart)
{
  const auto run = [](const bool restart) {
    Scene a;
    a.floor();
    add_column(a, 6, 10);
    a.step(5e-4, 30);
    a.stepper.forget_search();
    if (!restart)
      {
        a.step(5e-4, 30);
        return a.grains;
      }
    Scene b;
    b.floor();
    b.grains = a.grains;
    b.stepper.set_archive(a.stepper.archive());
    b.step(5e-4, 30);
    return b.grains;
  };
  const GrainArrays first = run(false), again = run(false), restarted = run(true);
  for (const GrainArrays *other : {&again, &restarted})
    {
      EXPECT_EQ(first.position[0], other->position[0]);
      EXPECT_EQ(first.velocity[1], other->velocity[1]);
      EXPECT_EQ(first.omega, other->omega);
      EXPECT_EQ(first.contact_force[0], other->contact_force[0]);
    }
}

TEST(Contacts, NotANumberIsAnError)
{
  Scene s;
  s.floor();
  s.add(0., r);
  s.grains.position[0][0] = std::nan("");
  EXPECT_THROW(s.step(1e-4), std::runtime_error);
}

TEST(Contacts, NoGrains)
{
  Scene s;
  s.floor();
  s.step(1e-4);
  EXPECT_EQ(s.report.wall_force["floor"][1], 0.);
}
