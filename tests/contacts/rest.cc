// When grains stand still, and what wakes them.
#include <alluvium/contacts/contact_stepper.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace alluvium::contacts;
using namespace alluvium::grains;

namespace
{
  constexpr double g = 9.81, r = 5e-4, dt = 1e-3;

  /** A column of discs between two walls. */
  struct Column
  {
    GrainArrays    grains;
    GrainLoads     loads;
    ContactStepper stepper;
    ContactReport  report;

    explicit Column(const unsigned int n)
    {
      stepper.settings().residual_tolerance = 1e-6;
      stepper.set_walls({{{{-r, 0.}}, {{r, 0.}}, {}, "floor"},
                         {{{-r, 0.}}, {{-r, 1.}}, {}, "left"},
                         {{{r, 0.}}, {{r, 1.}}, {}, "right"}});
      grains.resize(n);
      for (unsigned int k = 0; k < n; ++k)
        {
          grains.id[k]          = k;
          grains.position[1][k] = (2 * k + 1) * r;
          grains.radius[k]      = r;
          grains.mass[k]        = 1.;
        }
      load(1.);
    }

    void load(const double factor)
    {
      loads.reset(grains.n());
      for (double &f : loads.force[1])
        f = -g * factor;
    }

    void step(const unsigned int n = 1)
    {
      for (unsigned int k = 0; k < n; ++k)
        report = stepper.advance(grains, loads, dt, {{0., -g}});
    }
  };
} // namespace

TEST(Rest, UnchangedGrainsStandStill)
{
  Column column(5);
  column.step(column.stepper.settings().rest_steps);
  EXPECT_FALSE(column.report.at_rest);
  const auto y = column.grains.position[1];
  column.step(100);
  EXPECT_TRUE(column.report.at_rest);
  EXPECT_EQ(column.report.n_sweeps, 0u);
  EXPECT_EQ(column.grains.position[1], y);
  for (unsigned int k = 0; k < 5; ++k)
    {
      EXPECT_EQ(column.grains.velocity[1][k], 0.);
      EXPECT_EQ(column.grains.contact_force[1][k], g);
      EXPECT_TRUE(column.stepper.touched()[k]);
    }
  EXPECT_NEAR(column.report.wall_force.at("floor")[1], -5. * g, 1e-4 * g);
}

TEST(Rest, OtherLoadsWakeThem)
{
  Column column(5);
  column.step(50);
  ASSERT_TRUE(column.report.at_rest);
  column.load(0.5);
  column.step();
  EXPECT_FALSE(column.report.at_rest);
  EXPECT_NEAR(column.report.wall_force.at("floor")[1], -2.5 * g, 1e-4 * g);
  column.step(50);
  ASSERT_TRUE(column.report.at_rest);
  column.load(-1e-2);
  column.step(20);
  EXPECT_NEAR(column.grains.velocity[1][0], 20 * dt * 1e-2 * g, 1e-8);
}

TEST(Rest, ASlowChangeOfLoadAddsUp)
{
  Column column(5);
  column.step(50);
  ASSERT_TRUE(column.report.at_rest);
  for (unsigned int k = 1; k <= 1000; ++k)
    {
      column.load(1. - 1e-4 * k);
      column.step();
    }
  EXPECT_NEAR(column.report.wall_force.at("floor")[1], -5. * g * 0.9, 5e-3 * 5. * g);
}

TEST(Rest, AKickOrAMovedWallWakesThem)
{
  Column column(5);
  column.step(50);
  ASSERT_TRUE(column.report.at_rest);
  column.grains.velocity[1][4] = 0.1;
  column.step();
  EXPECT_FALSE(column.report.at_rest);
  EXPECT_NEAR(column.grains.velocity[1][4], 0.1 - g * dt, 1e-10);
  column.step(200);
  ASSERT_TRUE(column.report.at_rest);
  column.stepper.set_walls({});
  column.step();
  EXPECT_NEAR(column.grains.velocity[1][0], -g * dt, 1e-10);
}

// A step that stops a grain ends where the grain will stay, but carries more than its weight.
TEST(Rest, AStepThatStopsAGrainIsNoRest)
{
  Column column(1);
  column.grains.position[1][0] += 0.2 * g * dt * dt;
  const GrainArrays start = column.grains;
  column.step(20); // a try until it rests, as at the beginning of a run; then all is as before it
  column.grains = start;
  column.step(3);
  for (unsigned int k = 0; k < 30; ++k)
    {
      column.step();
      EXPECT_NEAR(column.report.wall_force.at("floor")[1], -g, 1e-3 * g) << k;
    }
  EXPECT_TRUE(column.report.at_rest);
}

TEST(Rest, ASlowSlopeIsNoRest)
{
  // A disc rolls down one in a thousand, with 2/3 g sin a.
  const double   slope = 1e-3;
  GrainArrays    grains;
  GrainLoads     loads;
  ContactStepper stepper;
  stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {}, "floor"}});
  grains.resize(1);
  grains.position[1][0] = grains.radius[0] = r;
  grains.mass[0]                           = 1.;
  loads.reset(1);
  loads.force[0][0] = g * std::sin(slope);
  loads.force[1][0] = -g * std::cos(slope);
  for (unsigned int k = 0; k < 200; ++k)
    stepper.advance(grains, loads, dt, {{g * std::sin(slope), -g * std::cos(slope)}});
  EXPECT_NEAR(grains.velocity[0][0], 2. / 3. * g * std::sin(slope) * 200 * dt, 1e-8);
}

TEST(Rest, CanBeSwitchedOff)
{
  Column column(5);
  column.stepper.settings().rest_steps = 0;
  column.step(100);
  EXPECT_FALSE(column.report.at_rest);
}

// A grain in mid-water that a slow stream carries along, less in a step than rest looks at: it touches nothing.
TEST(Rest, WhatTouchesNothingDoesNotSleep)
{
  const double   u = 1e-6, drag = 1e-3; // [m/s], [N s/m^2] of a grain of 1 kg/m: far slower than 4e-4 g allows
  GrainArrays    grains;
  GrainLoads     loads;
  ContactStepper stepper;
  ContactReport  report;
  stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {}, "floor"}});
  grains.resize(2);
  grains.id             = {0, 1};
  grains.position[1]    = {r, 10. * r};
  grains.radius         = {r, r};
  grains.mass           = {1., 1.};
  grains.velocity[0][1] = u;
  loads.reset(2);
  loads.force[1][0] = -g;
  loads.force[0][1] = drag * u;
  loads.drag[1]     = drag;
  for (unsigned int k = 0; k < 200; ++k)
    report = stepper.advance(grains, loads, dt, {{0., -g}});
  EXPECT_FALSE(report.at_rest);
  EXPECT_NEAR(grains.position[0][1] / (u * 200 * dt), 1., 1e-9);
  EXPECT_EQ(grains.contact_force[0][1], 0.);
}

// Nor do two that touch each other only, or one that creeps down a wall as fast as a thick fluid lets it.
TEST(Rest, WhatSinksTogetherDoesNotSleep)
{
  const double   u = 1e-6, drag = 1e3; // [m/s], [N s/m^2]
  GrainArrays    grains;
  GrainLoads     loads;
  ContactStepper stepper;
  ContactReport  report;
  stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {}, "floor"}});
  grains.resize(2);
  grains.id          = {0, 1};
  grains.position[1] = {10. * r, 12. * r};
  grains.radius      = {r, r};
  grains.mass        = {1., 1.};
  grains.velocity[1] = {-u, -u};
  loads.reset(2);
  loads.force[1] = {g, -g - 2. * drag * u}; // the upper one presses on the lower one
  loads.drag     = {drag, drag};
  for (unsigned int k = 0; k < 200; ++k)
    report = stepper.advance(grains, loads, dt, {{0., -g}});
  EXPECT_FALSE(report.at_rest);
  EXPECT_NEAR((10. * r - grains.position[1][0]) / (u * 200 * dt), 1., 1e-3);
}

TEST(Rest, WhatCreepsDownASlopeDoesNotSleep)
{
  const double   u = 1e-6, slope = 0.5, drag = g * std::sin(slope) / u;
  GrainArrays    grains;
  GrainLoads     loads;
  ContactStepper stepper;
  ContactReport  report;
  stepper.settings().wall_friction = 0.;
  stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {}, "slope"}});
  grains.resize(1);
  grains.id          = {0};
  grains.position[1] = {r};
  grains.radius      = {r};
  grains.mass        = {1.};
  grains.velocity[0] = {u};
  loads.reset(1);
  loads.force[0] = {g * std::sin(slope)};
  loads.force[1] = {-g * std::cos(slope)};
  loads.drag     = {drag};
  for (unsigned int k = 0; k < 200; ++k)
    report = stepper.advance(grains, loads, dt, {{g * std::sin(slope), -g * std::cos(slope)}});
  EXPECT_FALSE(report.at_rest);
  EXPECT_NEAR(grains.position[0][0] / (u * 200 * dt), 1., 1e-3);
}
