// Contact laws against exact answers: rolling friction, cohesion, and numbers of single walls.
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  /** Hold a grain where it is. */
  void fix(Scene &s, const std::size_t k)
  {
    s.grains.mass[k] = infinity;
  }

  /** One step with forces (fx, fy) on the grains, instead of gravity. */
  void step_with(Scene &s, const double dt, const std::vector<double> &fx, const std::vector<double> &fy)
  {
    s.loads.force[0] = fx;
    s.loads.force[1] = fy;
    s.loads.drag.assign(s.grains.n(), 0.);
    s.report = s.stepper.advance(s.grains, s.loads, dt, {{0., 0.}});
  }

  std::string number(const double x)
  {
    std::ostringstream text;
    text.precision(17);
    text << x;
    return text.str();
  }

  std::string error_of(Scene &s, const std::vector<WallSegment> &walls)
  {
    try
      {
        s.stepper.set_walls(walls);
      }
    catch (const UserError &e)
      {
        return e.what();
      }
    return "";
  }
} // namespace


// A disc stays on a slope of up to the coefficient; beyond it rolls with 2/3 (g sin a - mu_r g cos a).
TEST(RollingFriction, DiscOnIncline)
{
  for (const double slope : {0.1, 0.199, 0.201, 0.5})
    {
      Scene        s;
      const double a = std::atan(slope), mu_r = 0.2;
      s.set("set Rolling friction coefficient = 0.2\nset Wall friction coefficient = 1");
      s.exact();
      s.gx = g * std::sin(a);
      s.gy = -g * std::cos(a);
      s.floor();
      s.add(0., r);
      s.step(1e-4, 100);
      const double expected = slope < mu_r ? 0. : 2. / 3. * (std::sin(a) - mu_r * std::cos(a)) * g * 1e-2;
      EXPECT_NEAR(s.grains.velocity[0][0], expected, 1e-10) << slope;
      EXPECT_NEAR(r * s.grains.omega[0], -expected, 1e-10) << slope;
    }
}

// Discs of different size pressed together: a moment of mu_r R F each, opposite, until they turn alike.
TEST(RollingFriction, MomentOnAPair)
{
  Scene s;
  s.set("set Rolling friction coefficient = 0.1\nset Friction coefficient = 0");
  s.exact();
  s.add(0., 0.);
  s.add(3. * r, 0., 0., 0., 2. * r);
  s.grains.omega[0]  = 100.;
  const double force = 1., dt = 1e-5, reduced = 2. / 3. * r, moment = 0.1 * reduced * force;
  const double i0 = disc_inertia(s.grains.mass[0], r), i1 = disc_inertia(s.grains.mass[1], 2. * r);
  const double t_end = 100. / (moment / i0 + moment / i1);
  double       t     = 0.;
  for (int k = 0; k < 2000; ++k, t += dt)
    {
      const double elapsed = std::min(t, t_end);
      ASSERT_NEAR(s.grains.omega[0], 100. - moment / i0 * elapsed, 1e-7) << k;
      ASSERT_NEAR(s.grains.omega[1], moment / i1 * elapsed, 1e-7) << k;
      step_with(s, dt, {force, -force}, {0., 0.});
    }
  EXPECT_GT(t, 1.5 * t_end);
}

// With sliding friction too, unequal discs feel both clamps at once; the solution must satisfy all laws.
TEST(RollingFriction, WithSlidingFrictionConverges)
{
  Scene s;
  s.set("set Rolling friction coefficient = 0.05\nset Friction coefficient = 0.3");
  s.exact();
  s.add(0., 0.);
  s.add(4. * r, 0., 0., 0., 3. * r);
  s.grains.omega[0]   = 50.;
  s.grains.omega[1]   = 20.;
  const auto momentum = [&] {
    double l = 0.;
    for (int k = 0; k < 2; ++k)
      l += disc_inertia(s.grains.mass[k], s.grains.radius[k]) * s.grains.omega[k] +
           s.grains.mass[k] *
             (s.grains.position[0][k] * s.grains.velocity[1][k] - s.grains.position[1][k] * s.grains.velocity[0][k]);
    return l;
  };
  const double before = momentum();
  for (int k = 0; k < 3000; ++k)
    {
      // along the line of centres, so that no outer moment acts
      const double dx = s.grains.position[0][1] - s.grains.position[0][0],
                   dy = s.grains.position[1][1] - s.grains.position[1][0], l = std::hypot(dx, dy);
      step_with(s, 1e-5, {dx / l, -dx / l}, {dy / l, -dy / l});
      ASSERT_EQ(s.report.n_unconverged, 0u);
      ASSERT_LE(s.report.residual, 1e-12);
      EXPECT_NEAR(momentum(), before, 2e-3 * before); // the line of centres turns a little within each step
    }
  // neither slides nor rolls: one rigid body
  const double dx = s.grains.position[0][1] - s.grains.position[0][0],
               dy = s.grains.position[1][1] - s.grains.position[1][0], l = std::hypot(dx, dy);
  const double turn = ((s.grains.velocity[1][1] - s.grains.velocity[1][0]) * dx -
                       (s.grains.velocity[0][1] - s.grains.velocity[0][0]) * dy) /
                      (l * l);
  EXPECT_NEAR(s.grains.omega[0], s.grains.omega[1], 1e-3 * std::abs(turn));
  EXPECT_NEAR(s.grains.omega[0], turn, 1e-3 * std::abs(turn));
}

TEST(SingleWalls, FrictionAndRestitution)
{
  // two slides in one: tan a = 0.5 on floors of 0.3 and 0.6
  for (const bool rough : {false, true})
    {
      Scene        s;
      const double a = std::atan(0.5);
      s.set("set Friction of single walls = smooth: 0.3, rough: 0.6\nset Grains rotate = false");
      s.exact();
      s.gx = g * std::sin(a);
      s.gy = -g * std::cos(a);
      s.stepper.set_walls(
        {{{{-1., 0.}}, {{0., 0.}}, {{0., 0.}}, "smooth"}, {{{0., 0.}}, {{1., 0.}}, {{0., 0.}}, "rough"}});
      s.add(rough ? 0.5 : -0.5, r);
      s.step(1e-4, 10);
      EXPECT_NEAR(s.grains.velocity[0][0], rough ? 0. : (std::sin(a) - 0.3 * std::cos(a)) * g * 1e-3, 1e-12);
    }

  Scene s;
  s.set("set Restitution = 0.8\nset Restitution of single walls = lid: 0.5");
  s.gy = 0.;
  s.stepper.set_walls(
    {{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}, {{{-1., 5 * d}}, {{1., 5 * d}}, {{0., 0.}}, "lid"}});
  s.add(0., 2 * d, 0., 1.);
  s.step(1e-4, 50);
  EXPECT_NEAR(s.grains.velocity[1][0], -0.5, 1e-12);
  s.step(1e-4, 80);
  EXPECT_NEAR(s.grains.velocity[1][0], 0.4, 1e-12);
}

TEST(SingleWalls, UnknownNamesAreRefused)
{
  Scene s;
  s.set("set Friction of single walls = flor: 0.3");
  const std::string text =
    error_of(s, {{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}, {{{-1., 1.}}, {{1., 1.}}, {{0., 0.}}, "lid"}});
  for (const std::string part : {"Friction of single walls", "'flor'", "'floor', 'lid'"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  Scene e;
  e.set("set Restitution of single walls = floor: 1.3");
  EXPECT_NE(error_of(e, {{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}}).find("above 1"), std::string::npos);
}

// An adhesive pair holds up to exactly its force, and beyond parts with what is left.
TEST(Cohesion, PullOff)
{
  for (const double pull : {0.5, 0.9999, 1.0001, 2.})
    {
      Scene        s;
      const double c = 0.02, dt = 1e-4;
      s.set("set Cohesion = constant force\nsubsection Cohesion: constant force\n set Force = 0.02\nend");
      s.exact();
      s.add(0., 0.);
      s.add(d, 0.);
      const double m = s.grains.mass[0];
      step_with(s, dt, {-pull * c, pull * c}, {0., 0.});
      EXPECT_NEAR(s.grains.velocity[0][1], pull < 1. ? 0. : (pull - 1.) * c * dt / m, 1e-12) << pull;
      EXPECT_NEAR(s.grains.contact_force[0][1] / c, pull < 1. ? -pull : -1., 1e-10) << pull;
      for (int k = 0; k < 99; ++k)
        step_with(s, dt, {-pull * c, pull * c}, {0., 0.});
      if (pull < 1.)
        EXPECT_NEAR(s.grains.position[0][1] - s.grains.position[0][0], d, 1e-10 * d) << pull;
      else
        {
          // free from the second step on
          EXPECT_NEAR(s.grains.velocity[0][1], ((pull - 1.) + 99. * pull) * c * dt / m, 1e-10) << pull;
          EXPECT_EQ(s.grains.contact_force[0][1], 0.);
        }
    }
}

// Two discs hang from the ceiling if it carries the weight of both.
TEST(Cohesion, DiscsHangFromAWall)
{
  for (const double c : {1.98, 2.02, 5.})
    {
      Scene        s;
      const double mg = density * M_PI * r * r * g;
      s.set("set Cohesion = constant force\nsubsection Cohesion: constant force\n set Force = " + number(c * mg) +
            "\nend");
      s.exact();
      s.stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "ceiling"}});
      s.add(0., -r);
      s.add(0., -3. * r);
      s.step(1e-4, 100);
      if (c > 2.)
        {
          EXPECT_NEAR(s.grains.position[1][0] / r, -1., 1e-9);
          EXPECT_NEAR(s.grains.position[1][1] / r, -3., 1e-9);
          EXPECT_NEAR(s.report.wall_force["ceiling"][1] / mg, -2., 1e-9);
          EXPECT_NEAR(s.grains.contact_force[1][1] / mg, 1., 1e-9);
        }
      else
        {
          EXPECT_LT(s.grains.velocity[1][0], -0.9 * g * 1e-2);
          EXPECT_NEAR(s.grains.position[1][1] - s.grains.position[1][0], -d, 1e-9 * d); // the two stay together
        }
    }
}

// Cohesion presses grains together: Coulomb's limit is mu (r + c).
TEST(Cohesion, RaisesTheLimitOfFriction)
{
  for (const double c : {1.98, 2.02})
    {
      Scene        s;
      const double mg = density * M_PI * r * r * g;
      s.set("set Cohesion = constant force\nset Wall friction coefficient = 0.5\nset Grains rotate = false\n"
            "subsection Cohesion: constant force\n set Force = " +
            number(c * mg) + "\nend");
      s.exact();
      s.stepper.set_walls({{{{0., -1.}}, {{0., 1.}}, {{0., 0.}}, "side"}});
      s.add(r, 0.);
      s.step(1e-4, 100);
      EXPECT_NEAR(s.grains.velocity[1][0], c > 2. ? 0. : -(1. - 0.5 * c) * g * 1e-2, 1e-10);
      EXPECT_NEAR(s.grains.contact_force[0][0] / mg, 0., 1e-9);
    }
}

// A bridge pulls with its law until it ruptures, does not come back before a touch, and outlives searches and restarts.
TEST(Cohesion, LiquidBridge)
{
  Scene             first, restarted;
  Scene            *s    = &first;
  const std::string text = "set Cohesion = liquid bridge\nset Search skin = 1e-3\nsubsection Cohesion: liquid bridge\n"
                           " set Force = 0.02\n set Rupture distance = 0.4\n set Force at rupture = 0.25\nend";
  first.set(text);
  restarted.set(text);
  first.exact();
  restarted.exact();
  first.add(0., 0.);
  first.add(d, 0., 0.01);
  first.grains.mass[1] = 1.; // hardly slows down
  fix(first, 0);
  const double reach = 0.4 * 0.5 * r, dt = 1e-4;
  const auto   law      = [&](const double gap) { return 0.02 * (1. - 0.75 * gap / reach); };
  int          n_pulled = 0;
  for (int k = 0; k < 150; ++k)
    {
      const double gap = s->grains.position[0][1] - d;
      if (k == 50)
        {
          restarted.grains = first.grains;
          restarted.stepper.set_archive(first.stepper.archive());
          s = &restarted;
        }
      step_with(*s, dt, {0., 0.}, {0., 0.});
      ASSERT_NEAR(s->grains.contact_force[0][1], gap <= reach ? -law(gap) : 0., 1e-12) << k;
      n_pulled += gap <= reach;
    }
  EXPECT_NEAR(n_pulled * dt, reach / 0.01, 2. * dt);
  EXPECT_GT(s->grains.position[0][1] - d, 1.4 * reach);

  s->grains.velocity[0][1] = -0.01;
  while (s->grains.position[0][1] - d > 0.02 * reach)
    {
      step_with(*s, dt, {0., 0.}, {0., 0.});
      ASSERT_EQ(s->grains.contact_force[0][1], 0.);
    }
  for (int k = 0; k < 10; ++k)
    step_with(*s, dt, {0., 0.}, {0., 0.});
  s->grains.velocity[0][1] = 0.01;
  step_with(*s, dt, {0., 0.}, {0., 0.});
  EXPECT_NEAR(s->grains.contact_force[0][1], -0.02, 1e-6);
}
