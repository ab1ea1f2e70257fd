// The flow found anew after a change of the mesh.
#include "bed.h"

#include <gtest/gtest.h>

namespace
{
  using namespace bed;

  // Its iterations and loose solves are in the report of the step that follows.
  TEST(Rebalance, ItsSolvesAreCounted)
  {
    const Bed b = random_bed(1, 8., 8.);
    Settings  s;
    s.scheme = "implicit drag"; // one solve a step
    Channel channel(b.width, b.height, b.d, s, 100.);
    channel.step(b.grains, false);
    channel.step(b.grains, false);
    fluid::BlockVector before = channel.solver.old();
    before.zero_out_ghost_values();
    before *= 0.9;
    ASSERT_TRUE(channel.coupling.reinitialise_flow(channel.bc, b.grains, s.dt, before, 1.));
    const auto found = channel.solver.last_report();
    EXPECT_GT(found.n_iterations, 0u);
    channel.step(b.grains, false);
    const auto &report = channel.coupling.report();
    EXPECT_FALSE(channel.solver.last_report().loose);
    EXPECT_EQ(report.n_iterations, found.n_iterations + channel.solver.last_report().n_iterations);
    EXPECT_EQ(report.n_loose, static_cast<unsigned int>(found.loose));
    channel.step(b.grains, false);
    EXPECT_EQ(report.n_iterations, channel.solver.last_report().n_iterations);
    EXPECT_EQ(report.n_loose, 0u);
  }

  TEST(Rebalance, ItsDirectSolvesAreCountedOnce)
  {
    const Bed b = random_bed(1, 8., 8.);
    Settings  s;
    s.scheme = "implicit drag";
    Channel channel(b.width, b.height, b.d, s, 100.);
    channel.step(b.grains, true);
    channel.step(b.grains, true);
    auto              &linear_solver = channel.solver.linear_solver;
    fluid::BlockVector before        = channel.solver.old();
    before.zero_out_ghost_values();
    before *= 0.9;
    linear_solver.max_iterations = 1; // GMRES fails
    ASSERT_TRUE(channel.coupling.reinitialise_flow(channel.bc, b.grains, s.dt, before, 1.));
    const auto found = channel.solver.last_report();
    EXPECT_TRUE(found.direct);
    linear_solver.tolerance = 10.; // the flow is found steady
    channel.step(b.grains, true);
    const auto &report = channel.coupling.report();
    EXPECT_EQ(channel.solver.last_report().n_iterations, 0u);
    EXPECT_EQ(report.n_iterations, found.n_iterations);
    EXPECT_EQ(report.n_direct, 1u);
    channel.step(b.grains, true);
    EXPECT_TRUE(report.steady);
    EXPECT_EQ(report.n_iterations, 0u);
    EXPECT_EQ(report.n_direct, 0u);
  }
} // namespace
