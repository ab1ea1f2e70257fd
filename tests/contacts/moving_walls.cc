// Walls that move, appear and vanish at times.
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/utilities/checked_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  WallSegment wall(const std::array<double, 2> &a, const std::array<double, 2> &b, const WallMotion &motion)
  {
    WallSegment result{a, b, {{0., 0.}}, "wall"};
    result.motion  = std::make_shared<const WallMotion>(motion);
    result.present = motion.is_present(0.);
    return result;
  }

  WallMotion phase(const WallMotion::Velocity &velocity, const double from, const double to)
  {
    WallMotion motion;
    motion.phases.resize(1);
    motion.phases[0].velocity = velocity;
    motion.phases[0].from     = from;
    motion.phases[0].to       = to;
    return motion;
  }

  /** Take steps of @p dt up to step @p last, as a run does. */
  void go_on(Scene &s, const double dt, const int first, const int last)
  {
    for (int k = first; k < last; ++k)
      {
        s.stepper.set_time(k * dt);
        s.step(dt);
      }
  }
} // namespace


TEST(WallMotion, IsWhereItShouldBeWhateverTheSteps)
{
  const WallMotion motion = phase({{0.3, -0.1, 2.}}, 0.01234, 0.0471);
  for (const double dt : {1e-3, 0.007, 0.05, 0.1})
    {
      std::array<double, 3> way = {{0., 0., 0.}};
      for (int k = 0; k * dt < 0.1; ++k)
        for (unsigned int d = 0; d < 3; ++d)
          way[d] += dt * motion.mean_velocity(k * dt, dt)[d];
      for (unsigned int d = 0; d < 3; ++d)
        EXPECT_NEAR(way[d], (0.0471 - 0.01234) * motion.phases[0].velocity[d], 1e-14) << dt;
    }
  EXPECT_FALSE(motion.acts(0., 0.0123));
  EXPECT_TRUE(motion.acts(0., 0.0124));
  EXPECT_FALSE(motion.acts(0.0471, 1.));

  WallMotion swing;
  swing.phases.resize(1);
  swing.phases[0].at_time = [](const double t) { return WallMotion::Velocity{{std::cos(t), 0., 0.}}; };
  double x                = 0.;
  for (int k = 0; k < 100; ++k)
    x += 0.01 * swing.mean_velocity(0.01 * k, 0.01)[0];
  EXPECT_NEAR(x, std::sin(1.), 1e-7);
  EXPECT_TRUE(swing.ever_acts());
}

TEST(WallMotion, Presence)
{
  WallMotion motion;
  EXPECT_FALSE(motion.ever_acts());
  motion.present_to = 0.3;
  EXPECT_TRUE(motion.ever_acts());
  EXPECT_TRUE(motion.is_present(0.) && motion.is_present(0.2999999));
  EXPECT_FALSE(motion.is_present(0.1 + 0.1 + 0.1)); // a sum of steps
  EXPECT_FALSE(motion.is_present(1.));
  EXPECT_FALSE(motion.acts(0., 0.2));
  EXPECT_TRUE(motion.acts(0.2, 0.2));
}

// A belt stays where it is; what is rigid goes along itself, and drags grains along just so.
TEST(MovingWalls, ARigidWallMovesAlongItself)
{
  for (const bool rigid : {false, true})
    {
      Scene s;
      s.exact();
      s.gy           = 0.;
      s.gx           = g; // it falls against the gate
      WallSegment up = wall({{0., -1.}}, {{0., 1.}}, phase({{0., 0.2, 0.}}, 1e-3, 3e-3));
      up.rigid       = rigid;
      s.stepper.set_walls({up});
      s.add(-r, 0.);
      go_on(s, 1e-4, 0, 10);
      EXPECT_EQ(s.grains.velocity[1][0], 0.);
      go_on(s, 1e-4, 10, 20);
      EXPECT_NEAR(s.grains.velocity[1][0], 0.4 * g * 1e-3, 1e-12);
      go_on(s, 1e-4, 20, 60);
      EXPECT_NEAR(s.stepper.walls()[0].a[1], -1. + (rigid ? 4e-4 : 0.), 1e-13);
      EXPECT_NEAR(s.stepper.walls()[0].b[1], 1. + (rigid ? 4e-4 : 0.), 1e-13);
    }
}

// A disc sleeps on a floor; it wakes and falls when that goes, and what moves is where it should be after a restart.
TEST(MovingWalls, WhatVanishesWakesWhatItCarried)
{
  WallMotion floor;
  floor.present_to = 0.01;
  const auto make  = [&](Scene &s) {
    s.stepper.set_walls(
      {wall({{-1., 0.}}, {{1., 0.}}, floor), wall({{1., 1.}}, {{2., 1.}}, phase({{0., 0.1, 0.}}, 0.004, 0.02))});
  };
  Scene s;
  make(s);
  s.add(0., r);
  go_on(s, 1e-4, 0, 40);
  EXPECT_TRUE(s.report.at_rest); // before the other one moves
  go_on(s, 1e-4, 40, 100);
  EXPECT_NEAR(s.grains.position[1][0], r, 1e-8);
  EXPECT_NEAR(s.report.wall_force["wall"][1], -s.weight(), 1e-6 * s.weight());
  EXPECT_TRUE(s.stepper.walls()[0].present);
  ByteWriter writer;
  s.stepper.save(writer);
  Scene again;
  make(again);
  again.grains = s.grains;
  again.stepper.set_archive(s.stepper.archive());
  ByteReader reader(writer.bytes);
  again.stepper.load(reader);
  for (Scene *scene : {&s, &again})
    {
      go_on(*scene, 1e-4, 100, 150);
      EXPECT_FALSE(scene->stepper.walls()[0].present);
      EXPECT_NEAR(scene->grains.velocity[1][0], -g * 5e-3, 1e-9);
      EXPECT_NEAR(scene->stepper.walls()[1].a[1], 1. + 0.1 * 0.011, 1e-13);
    }
  EXPECT_EQ(s.grains.position[1], again.grains.position[1]);
}

TEST(MovingWalls, WhatIsNotThereYetTouchesNothing)
{
  WallMotion lid;
  lid.present_from = 1e-3;
  Scene s;
  s.exact();
  s.stepper.set_walls({wall({{-1., 0.}}, {{1., 0.}}, lid)});
  s.add(0., r);
  go_on(s, 1e-4, 0, 10);
  EXPECT_NEAR(s.grains.velocity[1][0], -g * 1e-3, 1e-12);
  EXPECT_EQ(s.report.wall_force["wall"][1], 0.);
}

// The work of a wall is what the grains get: of one that lifts a disc, and of one that turns, whose forces add up to
// nothing.
TEST(MovingWalls, Work)
{
  for (const char *model : {"non-smooth", "soft-sphere"})
    {
      Scene s;
      s.set(std::string("set Contact model = ") + model);
      s.stepper.set_walls({wall({{-1., 0.}}, {{1., 0.}}, phase({{0., 0.1, 0.}}, 0., 1.))});
      s.add(0., r);
      double work = 0.;
      for (int k = 0; k < 200; ++k)
        {
          go_on(s, 1e-4, k, k + 1);
          work += s.report.wall_work;
        }
      // lifted against its weight, and set in motion: half of that work is lost in the first impact
      EXPECT_NEAR(work, s.weight() * 0.1 * 0.02 + s.grains.mass[0] * 0.01, 0.02 * work) << model;
    }
  Scene blade;
  blade.gy = 0.;
  blade.stepper.set_walls({wall({{-0.01, 0.}}, {{0.01, 0.}}, phase({{0., 0., 10.}}, 0., 1.))});
  blade.add(0.009, 1.01 * r);
  blade.add(-0.009, -1.01 * r);
  double work = 0.;
  for (int k = 0; k < 10; ++k)
    {
      go_on(blade, 1e-4, k, k + 1);
      work += blade.report.wall_work;
    }
  EXPECT_GT(work, blade.kinetic_energy());
  EXPECT_NEAR(work, 2. * blade.kinetic_energy(), 0.1 * work);
}

// A wall that turns far in a step is followed in sub-steps: it takes the disc along and does not jump over it.
TEST(MovingWalls, AFastBladeJumpsOverNothing)
{
  Scene s;
  s.gy = 0.;
  s.stepper.set_walls({wall({{0., 0.}}, {{0.01, 0.}}, phase({{0., 0., 200.}}, 0., 1.))});
  s.add(0.005, 2. * r);
  s.stepper.set_time(0.);
  s.step(5e-3); // 1 rad
  EXPECT_GT(s.report.n_substeps, 9u);
  const double angle    = std::atan2(s.grains.position[1][0], s.grains.position[0][0]),
               distance = std::hypot(s.grains.position[0][0], s.grains.position[1][0]);
  EXPECT_GT(distance * std::sin(angle - 1.), 0.8 * r); // still before it
}

// What a piston pushes through a wall is named, however long the step: afterwards nobody overlaps.
TEST(MovingWalls, PressedThroughAWall)
{
  for (const double dt : {0.05, 0.1, 0.3})
    {
      Scene s;
      s.gy             = 0.;
      const double end = 15. * r;
      s.stepper.set_walls({wall({{0., -1.}}, {{0., 1.}}, phase({{0.05, 0., 0.}}, 0., 10.)),
                           {{{end, -1.}}, {{end, 1.}}, {{0., 0.}}, "side"}});
      s.add(10. * r, 0.);
      double deepest = 0.;
      for (int k = 0; k * dt < 0.3 && deepest < 0.1; ++k)
        {
          go_on(s, dt, k, k + 1);
          deepest = std::max({deepest, s.report.crush.depth, s.report.max_penetration / d});
        }
      EXPECT_GT(deepest, 0.1) << dt;
    }
}
