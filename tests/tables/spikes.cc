// Table and series of doc/lab/reports/smoothness.md: the pressure when grains cross cell faces.
#include "../coupling/pressure_ranges.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace moving_grain;

TEST(SpikesTable, Table)
{
  std::printf("\n| what moves | h/d | exact, R = 2 d | exact, R = r | centre | exact, R = r, rate | centre, rate |\n"
              "|---|---|---|---|---|---|---|\n");
  for (const unsigned int n : {1u, 5u})
    for (const double h : {4., 2., 1.})
      {
        const auto grains = n == 1 ? dragged_grain(Box::size) : moving_block(n);
        std::printf("| %s | %g |", n == 1 ? "a disc" : "25 discs", h);
        const auto show = [&](const double filter, const Rule rule, const Form form) {
          const double found = spike(pressure_ranges(grains, settings(h, filter), rule, form));
          std::printf(" %.1e |", found);
          std::fflush(stdout);
          return found;
        };
        const double filtered = show(2., Rule::moments, Form::flux), exact = show(0., Rule::moments, Form::flux);
        show(0., Rule::particle_centre, Form::flux);
        show(0., Rule::moments, Form::rate);
        const double jump = show(0., Rule::particle_centre, Form::rate);
        std::printf("\n");
        EXPECT_LT(filtered, 1e-3 * jump) << "h/d " << h;
        EXPECT_LT(exact, 1e-2 * jump) << "h/d " << h;
      }
}

/** The series behind the picture: path over d, range of the pressure over rho (d/dt)^2. */
TEST(SpikesTable, Series)
{
  const auto grain = dragged_grain(Box::size);
  const auto print = [&](const char *name, const double filter, const Rule rule, const Form form) {
    const auto range = pressure_ranges(grain, settings(2., filter), rule, form);
    EXPECT_FALSE(range.empty()) << name;
    for (std::size_t k = 0; k < range.size(); ++k)
      std::printf("series %s, %g %.6e\n", name, 1. + 0.02 * k, range[k] / (1000. * std::pow(speed / 0.02, 2)));
  };
  print("exact overlap with R = 2 d", 2., Rule::moments, Form::flux);
  print("exact overlap with R = r", 0., Rule::moments, Form::flux);
  print("exact overlap with the rate of eps", 0., Rule::moments, Form::rate);
  print("centre", 0., Rule::particle_centre, Form::flux);
  print("centre with the rate of eps", 0., Rule::particle_centre, Form::rate);
}
