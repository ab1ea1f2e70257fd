// A step that would be the last one again is not computed, and nobody can tell.
#include "bed.h"

#include <gtest/gtest.h>

namespace
{
  using namespace bed;

  TEST(SteadyFlow, IsNotSolvedAgainUntilSomethingChanges)
  {
    Bed          bed = random_bed(1, 20., 10.);
    Settings     settings;
    const double pressure = 0.5 * 1000. * 9.81 * bed.height;
    Channel      channel(bed.width, bed.height, bed.d, settings, pressure);
    const auto  &report = channel.coupling.report();
    const auto   step   = [&] { channel.step(bed.grains, true); };

    unsigned int n = 0;
    while (!report.steady && n < 200)
      {
        step();
        ++n;
      }
    ASSERT_LT(n, 200u);
    const double flux  = channel.solver.flux(3);
    const auto   force = channel.coupling.fluid_force();
    const auto   loads = channel.loads;
    step();
    EXPECT_TRUE(report.steady);
    EXPECT_EQ(channel.solver.flux(3), flux);
    EXPECT_EQ(channel.coupling.fluid_force(), force);
    EXPECT_EQ(channel.loads.force[1], loads.force[1]);
    EXPECT_GT(report.force_scale, 0.);

    // computed all the same, it is the same
    channel.coupling.forget_positions();
    step();
    EXPECT_FALSE(report.steady);
    EXPECT_EQ(channel.solver.flux(3), flux);
    EXPECT_EQ(channel.coupling.fluid_force(), force);
    step();
    EXPECT_TRUE(report.steady);

    // a grain's speed, its place, the time step, the head
    bed.grains.velocity[1][7] = 1e-9;
    step();
    EXPECT_FALSE(report.steady);
    bed.grains.velocity[1][7] = 0.;
    bed.grains.position[0][7] += 1e-4 * bed.d;
    step();
    EXPECT_FALSE(report.steady);
    for (n = 0; n < 200 && !report.steady; ++n)
      step();
    EXPECT_TRUE(report.steady);
    channel.settings.dt *= 1.01;
    step();
    EXPECT_FALSE(report.steady);
    for (n = 0; n < 200 && !report.steady; ++n)
      step();
    EXPECT_TRUE(report.steady);
    channel.bc.set(
      2, {boundary_kinds::pressure, "bottom", std::make_shared<Functions::ConstantFunction<2>>(1.001 * pressure)});
    step();
    EXPECT_FALSE(report.steady);
    step();
    EXPECT_NE(channel.solver.flux(3), flux);
  }
} // namespace
