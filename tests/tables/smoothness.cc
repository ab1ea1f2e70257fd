// Tables of doc/lab/reports/smoothness.md: the force on a disc that is dragged across cells.
#include "../coupling/dragged_grain.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace moving_grain;

namespace
{
  void table(const bool smooth)
  {
    constexpr double length = 4.;
    std::printf("\n%s filter, R = 2 d\n\n| h/d | one-way, d/50 | coupled, d/100 | d/50 | d/25 | d/10 | d/50: root mean "
                "square | triangles, d/50 | d/25 | ten times faster, d/50 | d/25 "
                "|\n|---|---|---|---|---|---|---|---|---|---|---|\n",
                smooth ? "Smooth" : "Even");
    for (const double h : {4., 2., 1., 0.5, 0.25})
      {
        bed::Settings s, triangles;
        s.h_over_d = triangles.h_over_d = h;
        s.smooth = triangles.smooth = smooth;
        triangles.triangles         = true;
        const Smoothness at         = dragged(s, 0.02, length);
        const double     twice      = dragged(s, 0.04, length).second_difference;
        const double     of_steps[] = {dragged(triangles, 0.02, length).second_difference,
                                       dragged(triangles, 0.04, length).second_difference,
                                       dragged(s, 0.02, length, 10. * speed).second_difference,
                                       dragged(s, 0.04, length, 10. * speed).second_difference};
        std::printf("| %g | %.1e | %.1e | %.1e | %.1e | %.1e | %.1e |",
                    h,
                    in_given_flow(s, 0.02, length).second_difference,
                    dragged(s, 0.01, length).second_difference,
                    at.second_difference,
                    twice,
                    dragged(s, 0.1, length).second_difference,
                    at.rms);
        for (const double value : of_steps)
          {
            std::printf(" %.1e |", value);
            EXPECT_LT(value, smooth ? 1e-3 : 1e-2) << "h/d " << h;
          }
        std::printf("\n");
        std::fflush(stdout);
        EXPECT_LT(at.second_difference, 1e-3) << "h/d " << h;
        EXPECT_LT(twice, smooth ? 1e-3 : 1e-2) << "h/d " << h;
      }
  }
} // namespace

TEST(SmoothnessTable, EvenFilter)
{
  table(false);
}

TEST(SmoothnessTable, SmoothFilter)
{
  table(true);
}

TEST(SmoothnessTable, WithoutFilter)
{
  std::printf("\n| h/d | R = r, one-way, d/50 | coupled, d/50 |\n|---|---|---|\n");
  for (const double h : {4., 2., 1., 0.5, 0.25})
    {
      bed::Settings s;
      s.h_over_d           = h;
      s.filter             = 0.;
      const double coupled = dragged(s, 0.02, 4.).second_difference;
      std::printf("| %g | %.1e | %.1e |\n", h, in_given_flow(s, 0.02, 4.).second_difference, coupled);
      std::fflush(stdout);
      EXPECT_GT(coupled, 1e-3) << "cells are felt without a filter: h/d " << h;
    }
}

/** The series behind the picture: path over d, and |force| over its mean. */
TEST(SmoothnessTable, Series)
{
  for (const double h : {4., 1., 0.25})
    for (const double filter : {2., 0.})
      {
        bed::Settings s;
        s.h_over_d = h;
        s.filter   = filter;
        Box        box(s, 0.02);
        const auto force = drag_along(box, 0.02, 4.);
        const auto mean  = smoothness(force).mean;
        EXPECT_GT(mean, 0.);
        for (std::size_t k = 0; k < force.size(); ++k)
          std::printf(
            "series h/d %g, R = %s, %g %.6f\n", h, filter > 0. ? "2 d" : "r", 1. + 0.02 * k, force[k].norm() / mean);
      }
}
