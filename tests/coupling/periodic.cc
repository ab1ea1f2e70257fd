// A channel that repeats itself: grains on its side are cut on both, and where the side is does not matter.
#include "bed.h"

#include <gtest/gtest.h>

using bed::Settings;

namespace
{
  /** The bed moved on by @p shift [m], as it looks in a box that repeats itself. */
  bed::Bed shifted(const bed::Bed &b, const double shift)
  {
    bed::Bed result = b;
    for (double &x : result.grains.position[0])
      x = std::fmod(x + shift, b.width);
    return result;
  }
} // namespace

TEST(Periodic, PiecesAddUpAcrossTheSide)
{
  Settings s;
  s.periodic = true;
  for (const double filter : {0., 1.5})
    {
      s.filter                     = filter;
      bed::Bed b                   = bed::random_bed(1, 10., 8.);
      b.grains.position[0].front() = 1e-9 * b.d;
      b.grains.position[0].back()  = (1. - 1e-12) * b.width;
      bed::Channel              channel(b.width, b.height, 0.5 * b.d, s, 0.);
      bed::coupling::OverlapMap map(channel.space);
      map.reinit();
      bed::coupling::OverlapSettings settings = channel.coupling.settings;
      map.cut(b.grains, settings);
      std::vector<double> area(b.grains.n(), 0.), at_left(b.grains.n(), 0.), at_right(b.grains.n(), 0.);
      const auto         &pieces = map.terms();
      for (unsigned int c = 0; c < channel.space.cells().size(); ++c)
        for (unsigned int k = pieces.begin[c]; k < pieces.begin[c + 1]; ++k)
          {
            const unsigned int g = map.grain()[k];
            area[g] += pieces.shape[k].area;
            (channel.space.cells()[c].vertex[0][0] < 0.5 * b.width ? at_left : at_right)[g] += pieces.shape[k].area;
          }
      bed::coupling::sum_over_ranks(area, map.communicator());
      bed::coupling::sum_over_ranks(at_left, map.communicator());
      bed::coupling::sum_over_ranks(at_right, map.communicator());
      for (std::size_t g = 0; g < b.grains.n(); ++g)
        EXPECT_NEAR(area[g] / (M_PI * b.grains.fluid_radius[g] * b.grains.fluid_radius[g]), 1., 1e-13);
      // half of a grain on the side is at the left, half at the right
      for (const std::size_t g : {std::size_t(0), b.grains.n() - 1})
        EXPECT_NEAR(at_left[g] / at_right[g], 1., 1e-8) << g;
    }
}

// By whole cells, the shifted bed is the same problem.
TEST(Periodic, FluxOfTheShiftedBed)
{
  for (const double h : {2., 1.})
    {
      const bed::Bed b = bed::random_bed(1, 20., 14.);
      Settings       s;
      s.periodic  = true;
      s.h_over_d  = h;
      double flux = 0.;
      for (const double cells : {0., 3., 7.})
        {
          const auto found = bed::fixed_bed_flux(shifted(b, cells * h * b.d), s);
          if (cells == 0.)
            flux = found.over_darcy;
          EXPECT_NEAR(found.over_darcy / flux, 1., 1e-6) << h << ' ' << cells;
          EXPECT_NEAR(found.over_darcy, 1., 0.05) << h; // the periodic boundary of the bed has been a wall
          EXPECT_NEAR(found.imbalance, 0., 1e-5);
          EXPECT_LT(found.third_law, 1e-12);
        }
    }
}
