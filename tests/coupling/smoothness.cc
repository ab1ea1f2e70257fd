// The force on a disc that is dragged across cells at constant velocity: it shall not feel where the cells end.
#include "moving_grain.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace moving_grain;

namespace
{
  /** The disc in vortices of 16 d that do not yield, with the pressure gradient that turns them; a wave of that size.
   */
  Smoothness in_given_flow(const bed::Settings &s, const double step, const double length)
  {
    const double               size = 16. * d, k = numbers::PI / size, u = 2. * speed, gamma = 5e5;
    bed::Channel               channel(size, size, s.h_over_d * d, s, 0.);
    bed::coupling::OverlapMap  map(channel.space);
    bed::grains::GrainArrays   grain = dragged_grain(size);
    const std::vector<uint8_t> touched(1, 0);
    auto                       field = channel.space.make_field();
    for (const auto &cell : channel.space.cells())
      for (unsigned int v = 0; v < channel.space.n_nodes_per_cell(); ++v)
        {
          const double x = k * cell.vertex[v][0], y = k * cell.vertex[v][1];
          field.block(0).local_element(cell.velocity[v][0]) = u * std::sin(x) * std::cos(y);
          field.block(0).local_element(cell.velocity[v][1]) = -u * std::cos(x) * std::sin(y);
          field.block(1).local_element(cell.pressure[v])    = gamma * u / k * std::cos(x) * std::sin(y);
        }
    map.reinit();
    std::vector<Tensor<1, 2>> force;
    for (unsigned int i = 0; i < length / step; ++i)
      {
        map.cut(grain, channel.coupling.settings);
        std::vector<bed::coupling::PieceField> at_pieces;
        bed::coupling::evaluate(map, channel.space, field, at_pieces);
        Tensor<1, 2> f;
        for (std::size_t p = 0; p < at_pieces.size(); ++p)
          for (unsigned int c = 0; c < 2; ++c)
            f[c] += map.terms().shape[p].area *
                    (gamma * (at_pieces[p].u[c] - (c == 0 ? grain.velocity[0][0] : grain.velocity[1][0])) -
                     at_pieces[p].grad_p[c]);
        force.push_back(f);
        grain.position[0][0] += step * d * std::cos(angle);
        grain.position[1][0] += step * d * std::sin(angle);
      }
    return smoothness(force);
  }

  Smoothness dragged(const bed::Settings &s, const double step, const double length, const double v = speed)
  {
    Box box(s, step, v);
    return smoothness(drag_along(box, step, length));
  }
} // namespace

TEST(Smoothness, DraggedGrain)
{
  for (const double h : {4., 1.})
    for (const bool triangles : {false, true})
      {
        bed::Settings s;
        s.h_over_d  = h;
        s.triangles = triangles;
        EXPECT_LT(dragged(s, 0.02, 1.5).second_difference, 1e-3) << "h/d " << h << " triangles " << triangles;
        s.smooth = true;
        EXPECT_LT(dragged(s, 0.04, 1.5).second_difference, 7e-4) << "h/d " << h << " triangles " << triangles;
      }
  // the measure sees cells where they are felt
  bed::Settings s;
  s.filter = 0.;
  EXPECT_GT(dragged(s, 0.02, 1.5).second_difference, 1e-2);
}

TEST(Smoothness, GrainInGivenFlow)
{
  for (const double h : {4., 2., 1., 0.5, 0.25})
    {
      bed::Settings s;
      s.h_over_d = h;
      EXPECT_LT(in_given_flow(s, 0.02, 4.).second_difference, 1e-3) << "h/d " << h;
    }
}

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

TEST(SmoothnessValidation, EvenFilter)
{
  table(false);
}

TEST(SmoothnessValidation, SmoothFilter)
{
  table(true);
}

TEST(SmoothnessValidation, WithoutFilter)
{
  std::printf("\n| h/d | R = r, one-way, d/50 | coupled, d/50 |\n|---|---|---|\n");
  for (const double h : {4., 2., 1., 0.5, 0.25})
    {
      bed::Settings s;
      s.h_over_d = h;
      s.filter   = 0.;
      std::printf("| %g | %.1e | %.1e |\n",
                  h,
                  in_given_flow(s, 0.02, 4.).second_difference,
                  dragged(s, 0.02, 4.).second_difference);
      std::fflush(stdout);
    }
}

/** The series behind the picture: path over d, and |force| over its mean. */
TEST(SmoothnessValidation, Series)
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
        for (std::size_t k = 0; k < force.size(); ++k)
          std::printf(
            "series h/d %g, R = %s, %g %.6f\n", h, filter > 0. ? "2 d" : "r", 1. + 0.02 * k, force[k].norm() / mean);
      }
}
