// What the pressure does when grains cross cell faces. A void fraction that jumps with a grain's centre, in a
// continuity equation with its rate, makes a spike of (pi/4) rho (d/dt)^2 or so; neither is done here, both are done
// for comparison.
#include "pressure_ranges.h"

#include <gtest/gtest.h>

using namespace moving_grain;

TEST(Spikes, NoneWhereOverlapsAreExact)
{
  const auto   grain = dragged_grain(Box::size);
  const double jump  = spike(pressure_ranges(grain, settings(2., 0.), Rule::particle_centre, Form::rate));
  EXPECT_GT(jump, 0.1);
  EXPECT_LT(spike(pressure_ranges(grain, settings(2., 0.), Rule::moments, Form::flux)), 1e-3 * jump);
  EXPECT_LT(spike(pressure_ranges(grain, settings(2., 2.), Rule::moments, Form::flux)), 1e-3 * jump);
  EXPECT_GT(spike(pressure_ranges(grain, settings(2., 0.), Rule::particle_centre, Form::flux)), 1e-3 * jump);
}
