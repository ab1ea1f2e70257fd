// Flux through a fixed random bed against the homogenised (Darcy) law, from cells far coarser than a grain to far
// finer.
#include "bed.h"

#include <gtest/gtest.h>

#include <cstdio>

using bed::Settings;

namespace
{
  Settings with(const double h_over_d)
  {
    Settings s;
    s.h_over_d = h_over_d;
    return s;
  }
} // namespace

TEST(FixedBed, FluxIsDarcys)
{
  const bed::Bed b = bed::random_bed(1, 45., 30.);
  for (const double h : {8., 4., 2., 1., 0.5})
    {
      const auto flux = bed::fixed_bed_flux(b, with(h));
      EXPECT_NEAR(flux.over_darcy, 1., 0.02) << "h/d " << h;
      EXPECT_NEAR(flux.imbalance, 0., 1e-5) << "h/d " << h;
      EXPECT_LT(flux.third_law, 1e-12) << "h/d " << h;
    }
}

TEST(FixedBed, FluxIsDarcysOnTriangles)
{
  const bed::Bed b = bed::random_bed(1, 45., 30.);
  for (const double h : {4., 1.})
    {
      Settings s      = with(h);
      s.triangles     = true;
      const auto flux = bed::fixed_bed_flux(b, s);
      EXPECT_NEAR(flux.over_darcy, 1., 0.02) << "h/d " << h;
      EXPECT_LT(flux.third_law, 1e-12) << "h/d " << h;
    }
}

// Three beds, all mesh sizes; the paper's own settings beside ours, whatever they give.
TEST(FixedBedValidation, ThreeSeedsAllSizes)
{
  std::printf("| seed | h/d | default | paper (R = r, centroid, consistent drag) | R = r, moments, lumped | R = 1.5 d "
              "|\n|---|---|---|---|---|---|\n");
  for (const unsigned int seed : {1, 2, 3})
    {
      const bed::Bed b = bed::random_bed(seed, 45., 30.);
      for (const double h : {8., 4., 2., 1., 0.5, 0.25})
        {
          const auto ours = bed::fixed_bed_flux(b, with(h));
          std::printf("| %u | %g | %.4f |", seed, h, ours.over_darcy);
          for (const int variant : {0, 1, 2})
            {
              Settings s = with(h);
              s.filter   = variant == 2 ? 1.5 : 0.;
              s.moments = s.lumped = variant > 0;
              try
                {
                  std::printf(" %.4f |", bed::fixed_bed_flux(b, s).over_darcy);
                }
              catch (const dealii::ExceptionBase &)
                {
                  std::printf(" linear solver fails |");
                }
            }
          std::printf("\n");
          std::fflush(stdout);
          EXPECT_NEAR(ours.over_darcy, 1., h < 0.5 ? 0.05 : 0.02) << "h/d " << h;
        }
    }
}
