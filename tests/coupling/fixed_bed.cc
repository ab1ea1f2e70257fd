// Flux through a fixed random bed against the homogenised (Darcy) law, from cells far coarser than a grain to far
// finer.
#include "bed.h"

#include <gtest/gtest.h>

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
      EXPECT_NEAR(flux.over_darcy, 1., 0.01) << "h/d " << h;
      EXPECT_NEAR(flux.imbalance, 0., 1e-5) << "h/d " << h;
      EXPECT_LT(flux.third_law, 1e-12) << "h/d " << h;
    }
}

TEST(FixedBed, FluxIsDarcysWithASmoothFilter)
{
  const bed::Bed b = bed::random_bed(1, 45., 30.);
  for (const double h : {8., 2., 0.5})
    {
      Settings s      = with(h);
      s.smooth        = true;
      const auto flux = bed::fixed_bed_flux(b, s);
      EXPECT_NEAR(flux.over_darcy, 1., 0.01) << "h/d " << h;
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
      EXPECT_NEAR(flux.over_darcy, 1., 0.01) << "h/d " << h;
      EXPECT_LT(flux.third_law, 1e-12) << "h/d " << h;
    }
}

TEST(FixedBed, SidesAndSeamsGiveTheSameFlux)
{
  // a small bed, where what happens along the sides matters
  const bed::Bed b = bed::random_bed(1, 16., 12.);
  for (const double h : {2., 0.5})
    {
      Settings   s     = with(h);
      const auto sides = bed::fixed_bed_flux(b, s, 0.02);
      s.periodic       = true;
      EXPECT_NEAR(sides.over_darcy, bed::fixed_bed_flux(b, s, 0.02).over_darcy, 0.01) << "h/d " << h;
    }
}
