// Tables of doc/lab/reports/drag.md: what each treatment of low void fractions gives, from cells far coarser than a grain
// to far finer.
#include "../coupling/bed.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace
{
  /** A square array of discs a distance 2 d apart between sides of symmetry. */
  bed::Bed square_array(const unsigned int n)
  {
    bed::Bed b;
    b.d     = 2.2e-4;
    b.width = b.height = 2. * n * b.d;
    b.grains.resize(n * n);
    for (unsigned int k = 0; k < n * n; ++k)
      {
        b.grains.id[k]          = k;
        b.grains.position[0][k] = (2. * (k % n) + 1.) * b.d;
        b.grains.position[1][k] = (2. * (k / n) + 1.) * b.d;
        b.grains.radius[k] = b.grains.fluid_radius[k] = 0.5 * b.d;
        b.grains.mass[k]                              = 1.;
      }
    return b;
  }

  /** Permeability of that array over that of the law `disc`, from Sangani and Acrivos (Int. J. Multiphase Flow 8,
   * 1982). */
  double resolved_over_homogenised()
  {
    const double phi = M_PI / 16.;
    const double force =
      4. * M_PI / (0.5 * std::log(1. / phi) - 0.738 + phi - 0.887 * phi * phi + 2.038 * phi * phi * phi);
    return M_PI / 4. * (2. / M_PI) * 4.8 * 4.8 * std::pow(1. - phi, -4.8) / force; // F / (eta U) of both
  }

  bed::Settings
  creeping(const double h_over_d, const double filter, const bool smooth, const std::string &regularisation)
  {
    bed::Settings s;
    s.h_over_d       = h_over_d;
    s.filter         = filter;
    s.smooth         = smooth;
    s.regularisation = regularisation;
    s.dt             = 1e-3;
    s.convection     = false;
    return s;
  }
} // namespace

// With a filter, void fractions stay where all treatments are the law itself: only one of them is run then.
TEST(DragRegularisationTable, RandomBedAndSquareArray)
{
  std::printf("square array, resolved: %.3f\n", resolved_over_homogenised());
  std::printf("| bed | R | h/d | none | floor | cap | penalisation |\n|---|---|---|---|---|---|---|\n");
  for (const bool random : {true, false})
    {
      const bed::Bed b = random ? bed::random_bed(1, 16., 12.) : square_array(4);
      for (const double filter : {0., 1.5, 2.})
        for (double h = 4.; h > (random ? 0.1 : 0.06); h /= 2.)
          {
            std::string row = std::string("| ") + (random ? "random" : "square") + " | " +
                              (filter == 0.   ? "r"
                               : filter == 2. ? "2 d"
                                              : "1.5 d") +
                              " | " + std::to_string(h).substr(0, 6) + " |";
            std::string last;
            for (const std::string name : {"none", "floor", "cap", "penalisation"})
              {
                if (filter == 0. || name == "none")
                  try
                    {
                      last = std::to_string(bed::fixed_bed_flux(b, creeping(h, filter, false, name), 1e-4).over_darcy)
                               .substr(0, 6);
                    }
                  catch (const dealii::ExceptionBase &)
                    {
                      last = "fails";
                    }
                row += (filter == 0. || name == "none" ? " " + last : std::string(" not run")) + " |";
              }
            std::printf("%s\n", row.c_str());
            std::fflush(stdout);
            if (!random && filter == 2.) // what is left is viscosity at the discs' edges, see doc/drag.md
              {
                EXPECT_NEAR(std::stod(last), 1., 0.06) << row;
              }
          }
    }
}

// Without an edge of the disc there is a limit as cells become small: water's gain by the looser paths.
TEST(DragRegularisationTable, SmoothFilter)
{
  std::printf("| smooth, R | bed | 4 | 2 | 1 | 0.5 | 0.25 | 0.125 | 0.0625 |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double filter : {1.5, 2., 2.5})
    for (const bool random : {false, true})
      {
        const bed::Bed b = random ? bed::random_bed(1, 16., 12.) : square_array(4);
        std::printf("| %g d | %s |", filter, random ? "random" : "square");
        double coarser = 0., at = 0.;
        for (double h = 4.; h > (random ? 0.1 : 0.06); h /= 2.)
          {
            coarser = at;
            at      = bed::fixed_bed_flux(b, creeping(h, filter, true, "none"), 1e-4).over_darcy;
            std::printf(" %.4f |", at);
            std::fflush(stdout);
          }
        std::printf("\n");
        if (filter >= 2.)
          {
            EXPECT_NEAR(at, coarser, 2e-3) << filter << " d";
          }
      }
}
