// Tables of doc/lab/reports/fixed-bed.md: flux through fixed random beds over Darcy's, from cells far coarser than a grain
// to far finer.
#include "../coupling/bed.h"

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

  /** Every mesh size, packing and kind of mesh; extremes over five beds. */
  void five_seeds_all_meshes(const double filter, const bool smooth)
  {
    std::printf("| packing | mesh | h/d | least flux | largest | largest velocity / U | pressure range / imposed "
                "|\n|---|---|---|---|---|---|---|\n");
    for (const double packing : {0.52, 0.45})
      {
        std::vector<bed::Bed> beds;
        for (unsigned int seed = 1; seed <= 5; ++seed)
          beds.push_back(bed::random_bed(seed, 45., 30., packing));
        for (const std::string mesh : {"uniform", "graded", "triangles"})
          for (const double h : {8., 4., 2., 1., 0.5, 0.25})
            {
              Settings s     = with(h);
              s.graded       = mesh == "graded";
              s.triangles    = mesh == "triangles";
              s.filter       = filter;
              s.smooth       = smooth;
              double     low = 10., high = 0., u_max = 0., range = 0.;
              const auto expect = [&](const bool holds) { EXPECT_TRUE(holds) << mesh << ", h/d " << h; };
              for (const bed::Bed &b : beds)
                {
                  const auto flux = bed::fixed_bed_flux(b, s, 0.02);
                  low             = std::min(low, flux.over_darcy);
                  high            = std::max(high, flux.over_darcy);
                  u_max           = std::max(u_max, flux.u_max_over_superficial);
                  range           = std::max(range, flux.pressure_range);
                }
              std::printf(
                "| %g | %s | %g | %.4f | %.4f | %.2f | %.4f |\n", packing, mesh.c_str(), h, low, high, u_max, range);
              std::fflush(stdout);
              // a smooth filter has no viscosity at its edge, which would take back what the beds' looser paths give
              const double tolerance = smooth ? 0.015 : h < 0.5 ? 0.03 : 0.01;
              expect(low > 1. - tolerance && high < 1. + tolerance);
              expect(u_max < 8.);
              expect(range < 1.01);
            }
      }
  }
} // namespace

TEST(FixedBedTable, FiveSeedsAllMeshes)
{
  five_seeds_all_meshes(2., false);
}

TEST(FixedBedTable, FiveSeedsAllMeshesSmooth)
{
  five_seeds_all_meshes(2.5, true);
}

// The stabilisation knows of the time step; the stationary flux should not.
TEST(FixedBedTable, TimeSteps)
{
  const bed::Bed            b  = bed::random_bed(1, 45., 30.);
  const std::vector<double> dt = {1e-4, 1e-3, 1e-2, 1e-1};
  std::printf("| filter | h/d | dt 1e-4 | 1e-3 | 1e-2 | 1e-1 |\n|---|---|---|---|---|---|\n");
  for (const double filter : {2., 0.})
    for (const double h : {4., 1., 0.5, 0.25})
      {
        if (filter == 0. && h < 0.5)
          continue;
        Settings s = with(h);
        s.filter   = filter;
        double low = 10., high = 0.;
        std::printf("| %s | %g |", filter > 0. ? "2 d" : "grain", h);
        for (const double step : dt)
          {
            s.dt              = step;
            const double flux = bed::fixed_bed_flux(b, s, 0.02).over_darcy;
            low               = std::min(low, flux);
            high              = std::max(high, flux);
            std::printf(" %.4f |", flux);
          }
        std::printf("\n");
        std::fflush(stdout);
        if (filter > 0.)
          {
            EXPECT_LT(high - low, 0.01) << "h/d " << h;
          }
      }
}

// Three beds, all mesh sizes; the paper's own settings beside ours, whatever they give.
TEST(FixedBedTable, ThreeSeedsAllSizes)
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
          EXPECT_NEAR(ours.over_darcy, 1., h < 0.5 ? 0.03 : 0.01) << "h/d " << h;
        }
    }
}
