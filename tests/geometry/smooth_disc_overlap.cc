#include <alluvium/geometry/smooth_disc_overlap.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "meshes.h"

using namespace overlap_test;

namespace
{
  constexpr double h_over_d[] = {8., 2., 1., 0.5, 0.25, 0.125};
  constexpr Shape  shapes[]   = {Shape::squares, Shape::triangles, Shape::distorted};

  /** Area, first and second moments about the disc's centre, in units of its radius. */
  using Moments = std::array<long double, 6>;

  Moments moments(const Overlap &o, const Disc &disc)
  {
    const long double r = disc.radius, a = o.area / (r * r), x = o.arm[0] / r, y = o.arm[1] / r;
    const auto        second = [&](const unsigned c) { return o.second_moments[c] / (r * r * r * r); };
    return {{a, a * x, a * y, second(0) + a * x * x, second(1) + a * x * y, second(2) + a * y * y}};
  }

  void widen(Moments &worst, const Moments &a, const Moments &b)
  {
    for (unsigned i = 0; i < 6; ++i)
      if (!(std::abs(a[i] - b[i]) <= worst[i])) // written so that a NaN stays
        worst[i] = std::abs(a[i] - b[i]);
  }

  void expect_below(const double bound, const Moments &worst)
  {
    for (unsigned i = 0; i < 6; ++i)
      {
        std::printf("moment %u: %.1Le\n", i, worst[i]);
        EXPECT_LE(worst[i], bound) << "moment " << i;
      }
  }

  /**
   * The same from even discs alone: the weight is a pile of discs of radius s, its moments the integrals over s of 4 s
   * times those of overlap(). In between the radii at which the circle meets a vertex or touches an edge the integrand
   * is smooth but for roots at the ends, for which there is the tanh-sinh rule.
   */
  Moments from_even_discs(const Disc &disc, const PreparedPolygon &cell)
  {
    std::vector<double> breaks = {0., 1.};
    for (unsigned i = 0; i < 4; ++i)
      {
        const double x = (cell.x[i] - disc.centre[0]) / disc.radius, y = (cell.y[i] - disc.centre[1]) / disc.radius;
        for (const double s : {std::hypot(x, y), std::abs(x * cell.tangent_y[i] - y * cell.tangent_x[i])})
          if (s < 1.)
            breaks.push_back(s);
      }
    std::sort(breaks.begin(), breaks.end());
    constexpr unsigned n = 80;
    Moments            sum{};
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
      for (unsigned i = 0; i < n && breaks[k + 1] > breaks[k]; ++i)
        {
          const double length = breaks[k + 1] - breaks[k], t = 8. * (i + 0.5) / n - 4.;
          const double u = std::tanh(M_PI / 2. * std::sinh(t)), du = (1. - u * u) * M_PI / 2. * std::cosh(t) * 8. / n;
          const double s = breaks[k] + 0.5 * (1. + u) * length;
          if (s > 0.)
            {
              const Moments m = moments(overlap({disc.centre, s * disc.radius}, cell), disc);
              for (unsigned c = 0; c < 6; ++c)
                sum[c] += 4. * s * 0.5 * length * du * m[c];
            }
        }
    return sum;
  }

  template <class F>
  void for_all(const unsigned n_discs, F &&f)
  {
    for (const Shape shape : shapes)
      {
        const Mesh mesh(shape, 100, 0.0173);
        Rng        rng(42);
        for (const double ratio : h_over_d)
          for (unsigned i = 0; i < n_discs; ++i)
            for (const Disc &disc :
                 {random_disc(mesh, mesh.h / (2 * ratio), rng), adversarial_disc(mesh, mesh.h / (2 * ratio), rng)})
              f(mesh, disc);
      }
  }
} // namespace

TEST(SmoothDiscOverlap, PiecesAddUpToTheDisc)
{
  Moments worst{};
  double  outside = 0.; // way of a centroid out of its cell, over h
  for_all(1000, [&](const Mesh &mesh, const Disc &disc) {
    Moments sum{};
    mesh.for_each_near(disc, [&](const unsigned c) {
      const PreparedPolygon &cell = mesh.cells[c];
      const Overlap          o    = smooth_overlap(disc, cell);
      const Moments          m    = moments(o, disc);
      for (unsigned i = 0; i < 6; ++i)
        sum[i] += m[i];
      for (unsigned i = 0; i < 4 && o.area > 0.; ++i)
        outside = std::max(
          outside,
          (cell.tangent_y[i] * (o.centroid[0] - cell.x[i]) - cell.tangent_x[i] * (o.centroid[1] - cell.y[i])) / mesh.h);
    });
    widen(worst, sum, {{M_PIl, 0, 0, M_PIl / 6, 0, M_PIl / 6}});
  });
  expect_below(2e-12, worst); // a hundred slivers of 1e-13 may be dropped
  EXPECT_LE(outside, 1e-13);
}

TEST(SmoothDiscOverlap, IsAPileOfEvenDiscs)
{
  Moments worst{};
  for_all(6, [&](const Mesh &mesh, const Disc &disc) {
    mesh.for_each_near(disc, [&](const unsigned c) {
      widen(worst, moments(smooth_overlap(disc, mesh.cells[c]), disc), from_even_discs(disc, mesh.cells[c]));
    });
  });
  expect_below(1e-12, worst);
}

// the weight is a polynomial there: a rectangle from (a, c) to (b, d), all in units of R
TEST(SmoothDiscOverlap, CellInDisc)
{
  const double          a = -0.3, b = 0.5, c = 0.1, d = 0.4, R = 0.7, x = 3., y = -2.;
  const auto            at = [&](const double s, const double t) { return Point2{{x + s * R, y + t * R}}; };
  const PreparedPolygon cell(ConvexPolygon{{{at(a, c), at(b, c), at(b, d), at(a, d)}}, 4});
  const auto            power = [](const double from, const double to, const unsigned n) {
    return (std::pow(to, n + 1) - std::pow(from, n + 1)) / (n + 1);
  };
  const auto exact = [&](const unsigned i, const unsigned j) -> long double {
    return 2. * (power(a, b, i) * power(c, d, j) - power(a, b, i + 2) * power(c, d, j) -
                 power(a, b, i) * power(c, d, j + 2));
  };
  const Disc disc{{{x, y}}, R};
  Moments    worst{};
  widen(worst,
        moments(smooth_overlap(disc, cell), disc),
        {{exact(0, 0), exact(1, 0), exact(0, 1), exact(2, 0), exact(1, 1), exact(0, 2)}});
  expect_below(1e-15, worst);
}
