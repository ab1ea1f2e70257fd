#include <alluvium/geometry/disc_polygon_overlap.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "meshes.h"
#include "reference_overlap.h"

using namespace overlap_test;

namespace
{
  // the two ends are beyond what grains need: a lone small grain, and a filter's disc of many cells
  constexpr double h_over_d[] = {64., 8., 4., 2., 1., 0.5, 0.25, 0.125, 0.03125};
  constexpr Shape  shapes[]   = {Shape::squares, Shape::triangles, Shape::distorted};

  PreparedPolygon rectangle(const double x0, const double y0, const double x1, const double y1)
  {
    return PreparedPolygon(ConvexPolygon{{{{{x0, y0}}, {{x1, y0}}, {{x1, y1}}, {{x0, y1}}}}, 4});
  }

  void expect_overlap(const Overlap               &o,
                      const double                 area,
                      const Point2                &centroid,
                      const std::array<double, 3> &second,
                      const double                 tolerance)
  {
    EXPECT_NEAR(o.area, area, tolerance);
    for (unsigned c = 0; c < 2; ++c)
      EXPECT_NEAR(o.centroid[c], centroid[c], tolerance);
    for (unsigned c = 0; c < 3; ++c)
      EXPECT_NEAR(o.second_moments[c], second[c], tolerance);
  }

  /** Largest errors of the sums over all cells of a mesh. */
  struct SumErrors
  {
    double area = 0., arm = 0., position = 0., second = 0.;

    void add(const Mesh &mesh, const Disc &disc)
    {
      long double area_sum = 0, mx = 0, my = 0, px = 0, py = 0, xx = 0, xy = 0, yy = 0;
      mesh.for_each_near(disc, [&](const unsigned cell) {
        const Overlap     o = overlap(disc, mesh.cells[cell]);
        const long double a = o.area, x = o.arm[0], y = o.arm[1];
        area_sum += a;
        mx += a * x;
        my += a * y;
        px += a * o.centroid[0];
        py += a * o.centroid[1];
        xx += o.second_moments[0] + a * x * x;
        xy += o.second_moments[1] + a * x * y;
        yy += o.second_moments[2] + a * y * y;
      });
      const long double r = disc.radius, exact = M_PIl * r * r;
      const auto        update = [](double &worst, const long double error) {
        // written so that a NaN stays
        if (!(std::abs(error) <= worst))
          worst = static_cast<double>(std::abs(error));
      };
      const long double x = disc.centre[0], y = disc.centre[1];
      update(area, (area_sum - exact) / exact);
      update(arm, mx / (exact * r));
      update(arm, my / (exact * r));
      update(position, (px - exact * x) / (exact * (std::abs(x) + r)));
      update(position, (py - exact * y) / (exact * (std::abs(y) + r)));
      update(second, (xx - exact * r * r / 4) / (exact * r * r / 4));
      update(second, xy / (exact * r * r / 4));
      update(second, (yy - exact * r * r / 4) / (exact * r * r / 4));
    }
  };

  /** Largest errors of single pieces against the reference and largest way of a centroid out of cell or disc, over
   * powers of min(r, h). */
  struct PieceErrors
  {
    double   area = 0., first = 0., second = 0., outside = 0.;
    unsigned n_slivers = 0, n_pieces = 0;

    void add(const Disc &disc, const ConvexPolygon &polygon, const PreparedPolygon &cell, const double h)
    {
      const auto update = [](double &worst, const long double error) {
        if (!(std::abs(error) <= worst))
          worst = static_cast<double>(std::abs(error));
      };
      const Overlap          o = overlap(disc, cell);
      const ReferenceMoments m = reference_overlap(disc, polygon);
      const long double      r = disc.radius, l = std::min<long double>(disc.radius, h), a = o.area;
      // what the reference has below this is its own round-off
      const bool        piece = m.area * r * r > 1e-16L * l * l;
      const long double gx = piece ? m.x / m.area : 0, gy = piece ? m.y / m.area : 0;
      update(area, (a - m.area * r * r) / (l * l));
      update(first, (a * o.arm[0] - m.x * r * r * r) / (l * l * l));
      update(first, (a * o.arm[1] - m.y * r * r * r) / (l * l * l));
      update(second, (o.second_moments[0] - (piece ? m.xx - m.x * gx : 0) * r * r * r * r) / (l * l * l * l));
      update(second, (o.second_moments[1] - (piece ? m.xy - m.x * gy : 0) * r * r * r * r) / (l * l * l * l));
      update(second, (o.second_moments[2] - (piece ? m.yy - m.y * gy : 0) * r * r * r * r) / (l * l * l * l));

      if (o.area == 0.)
        return;
      ++n_pieces;
      n_slivers += o.area < 1e-10 * l * l;
      const long double x = o.arm[0], y = o.arm[1];
      update(outside, std::max<long double>(0, (std::hypot(x, y) - r) / l));
      for (unsigned i = 0; i < polygon.n; ++i)
        {
          const Point2     &p = polygon.vertex[i], &q = polygon.vertex[(i + 1) % polygon.n];
          const long double dx = q[0] - p[0], dy = q[1] - p[1];
          const long double px = x + disc.centre[0] - p[0], py = y + disc.centre[1] - p[1];
          update(outside, std::max<long double>(0, (dy * px - dx * py) / std::hypot(dx, dy) / l));
        }
      const auto &s = o.second_moments;
      EXPECT_GE(s[0], 0.);
      EXPECT_GE(s[2], 0.);
      EXPECT_GE(s[0] * s[2] - s[1] * s[1], -1e-15 * (s[0] + s[2]) * (s[0] + s[2]));
    }
  };
} // namespace


TEST(DiscPolygonOverlap, ClosedForms)
{
  const double pi = M_PI;
  const Disc   unit{{{0., 0.}}, 1.};
  // half and quarter of the disc
  expect_overlap(overlap(unit, rectangle(0., -2., 3., 2.)),
                 pi / 2,
                 {{4 / (3 * pi), 0.}},
                 {{pi / 8 - 8 / (9 * pi), 0., pi / 8}},
                 1e-15);
  expect_overlap(overlap(unit, rectangle(0., 0., 3., 2.)),
                 pi / 4,
                 {{4 / (3 * pi), 4 / (3 * pi)}},
                 {{pi / 16 - 4 / (9 * pi), 1. / 8 - 4 / (9 * pi), pi / 16 - 4 / (9 * pi)}},
                 1e-15);
  // three quarters less the square of side sin(45 deg): a segment of 90 degrees
  const double c = std::sqrt(0.5);
  const double s = pi / 4 - 0.5, g = 2. / 3 * c * c * c / s;
  expect_overlap(overlap(unit, rectangle(c, -2., 3., 2.)),
                 s,
                 {{g, 0.}},
                 {{s / 4 + 0.25 / 2 - s * g * g, 0., s / 4 - 0.25 / 6}},
                 1e-15);
  // all but that segment: its arc is 270 degrees
  const double b = pi - s;
  expect_overlap(overlap(unit, rectangle(-3., -2., c, 2.)),
                 b,
                 {{-s * g / b, 0.}},
                 {{pi / 4 - s / 4 - 0.25 / 2 - s * g * s * g / b, 0., pi / 4 - s / 4 + 0.25 / 6}},
                 1e-15);
  // a square all of whose sides cut the disc: the disc less four segments of half angle acos(0.8), sin = 0.6
  const double t = std::acos(0.8) - 0.48, s3c = 0.6 * 0.6 * 0.6 * 0.8;
  const double both = 2 * (t / 4 + s3c / 2) + 2 * (t / 4 - s3c / 6);
  expect_overlap(overlap(unit, rectangle(-0.8, -0.8, 0.8, 0.8)),
                 pi - 4 * t,
                 {{0., 0.}},
                 {{pi / 4 - both, 0., pi / 4 - both}},
                 1e-15);
  // a triangle with a corner of 60 degrees on the centre
  const PreparedPolygon wedge(ConvexPolygon{{{{{0., 0.}}, {{3., 0.}}, {{1.5, 1.5 * std::sqrt(3.)}}}}, 3});
  expect_overlap(overlap(unit, wedge),
                 pi / 6,
                 {{std::sqrt(3.) / pi, 1. / pi}},
                 {{pi / 24 + std::sqrt(3.) / 32 - 1 / (2 * pi),
                   3. / 32 - std::sqrt(3.) / (6 * pi),
                   pi / 24 - std::sqrt(3.) / 32 - 1 / (6 * pi)}},
                 1e-15);
  // disc in cell, cell in disc, far away from the origin
  expect_overlap(
    overlap({{{10., 20.}}, 0.5}, rectangle(9., 19., 11., 21.)), pi / 4, {{10., 20.}}, {{pi / 64, 0., pi / 64}}, 1e-16);
  expect_overlap(
    overlap({{{10., 20.}}, 3.}, rectangle(9., 19., 11., 20.)), 2., {{10., 19.5}}, {{2. / 3, 0., 1. / 6}}, 1e-15);
  const PreparedPolygon corner(ConvexPolygon{{{{{0., 0.}}, {{3., 0.}}, {{0., 6.}}}}, 3});
  expect_overlap(overlap({{{1., 2.}}, 9.}, corner), 9., {{1., 2.}}, {{4.5, -4.5, 18.}}, 1e-14);
}


TEST(DiscPolygonOverlap, NothingInCommon)
{
  const auto square = rectangle(0., 0., 1., 1.);
  for (const Disc &disc : {Disc{{{2., 0.5}}, 0.5},   // far
                           Disc{{{1.5, 0.5}}, 0.5},  // touches a side
                           Disc{{{1.4, 1.4}}, 0.5},  // in the bounding box's reach, beside the corner
                           Disc{{{1.3, 1.4}}, 0.5}}) // touches the corner
    {
      const Overlap o = overlap(disc, square);
      EXPECT_NEAR(o.area, 0., 1e-15 * 0.25);
    }
  const PreparedPolygon triangle(ConvexPolygon{{{{{0., 0.}}, {{4., 0.}}, {{0., 4.}}}}, 3});
  EXPECT_EQ(overlap({{{3., 3.}}, 0.5}, triangle).area, 0.); // inside the bounding box, outside the triangle
}


TEST(DiscPolygonOverlap, MomentsOfWholePolygons)
{
  const PreparedPolygon trapezium(ConvexPolygon{{{{{1., 1.}}, {{5., 1.}}, {{4., 3.}}, {{2., 3.}}}}, 4});
  EXPECT_DOUBLE_EQ(trapezium.area, 6.);
  EXPECT_DOUBLE_EQ(1. + trapezium.centroid_offset[0], 3.);
  EXPECT_DOUBLE_EQ(1. + trapezium.centroid_offset[1], 1. + 8. / 9);
  EXPECT_DOUBLE_EQ(trapezium.second_moments[0], 5.); // H (a + b)(a^2 + b^2)/48
  EXPECT_NEAR(trapezium.second_moments[1], 0., 1e-14);
  EXPECT_DOUBLE_EQ(trapezium.second_moments[2], 52. / 27); // H^3 (a^2 + 4ab + b^2)/(36 (a + b))
}


TEST(DiscPolygonOverlap, RefusesWhatIsNotConvex)
{
  const Point2 a{{0., 0.}}, b{{1., 0.}}, c{{1., 1.}}, d{{0., 1.}}, dent{{0.4, 0.4}};
  EXPECT_NO_THROW(PreparedPolygon(ConvexPolygon{{{a, b, c, d}}, 4}));
  EXPECT_NO_THROW(PreparedPolygon(ConvexPolygon{{{a, {{0.5, 0.}}, b, d}}, 4})); // a straight angle
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, d, c, b}}, 4}), std::invalid_argument);
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, b, d, c}}, 4}), std::invalid_argument); // deal.II's order
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, b, dent, d}}, 4}), std::invalid_argument);
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, c, b}}, 3}), std::invalid_argument);
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, b, b}}, 3}), std::invalid_argument);
  EXPECT_THROW(PreparedPolygon(ConvexPolygon{{{a, b, c, d}}, 2}), std::invalid_argument);
}


// Over the cells of a mesh the pieces add up to the disc: 1e-14 of pi r^2, pi r^3 and pi r^4/4 in the three moments;
// the first moment from absolute positions to 1e-14 of pi r^2 (|x| + r), as a position of |x| has no more digits.
TEST(DiscPolygonOverlap, PiecesAddUpToTheDisc)
{
  for (const Shape shape : shapes)
    for (const double h : {1., 0.0173})
      {
        const Mesh mesh(shape, 100, h);
        Rng        rng(42);
        for (const double ratio : h_over_d)
          {
            const double r = mesh.h / (2 * ratio);
            SumErrors    random, adversarial;
            for (unsigned i = 0; i < (ratio < 0.1 ? 1000 : 25000); ++i)
              {
                random.add(mesh, random_disc(mesh, r, rng));
                adversarial.add(mesh, adversarial_disc(mesh, r, rng));
              }
            for (const SumErrors *errors : {&random, &adversarial})
              {
                const SumErrors &e = *errors;
                SCOPED_TRACE(std::string(name(shape)) + ", h/d " + std::to_string(ratio) +
                             (errors == &random ? ", random" : ", adversarial"));
                std::printf("%-10s h/d %-6g area %.1e  arm %.1e  position %.1e  second %.1e\n",
                            name(shape),
                            ratio,
                            e.area,
                            e.arm,
                            e.position,
                            e.second);
                EXPECT_LE(e.area, 1e-14);
                EXPECT_LE(e.arm, 1e-14);
                EXPECT_LE(e.position, 1e-14);
                EXPECT_LE(e.second, 1e-14);
              }
          }
      }
}


// Each piece against the reference: 1e-13 of the matching power of min(r, h), and the centroid in both disc and cell.
TEST(DiscPolygonOverlap, EveryPieceMeetsTheReference)
{
  for (const Shape shape : shapes)
    {
      const Mesh mesh(shape, 100, 0.0173);
      Rng        rng(7);
      for (const double ratio : h_over_d)
        {
          const double r = mesh.h / (2 * ratio);
          PieceErrors  e;
          while (e.n_pieces < 20000)
            for (const Disc &disc : {random_disc(mesh, r, rng), adversarial_disc(mesh, r, rng)})
              mesh.for_each_near(disc, [&](const unsigned c) { e.add(disc, mesh.polygons[c], mesh.cells[c], mesh.h); });
          SCOPED_TRACE(std::string(name(shape)) + ", h/d " + std::to_string(ratio));
          std::printf("%-10s h/d %-8g area %.1e  first %.1e  second %.1e  centroid outside %.1e, %u slivers\n",
                      name(shape),
                      ratio,
                      e.area,
                      e.first,
                      e.second,
                      e.outside,
                      e.n_slivers);
          EXPECT_LE(e.area, 1e-13);
          EXPECT_LE(e.first, 1e-13);
          EXPECT_LE(e.second, 1e-13);
          EXPECT_LE(e.outside, 1e-13);
        }
    }
}


// Where the arc between leaving and entering is nearly all of the circle, or nearly none, by a few ulp: a vertex with
// an angle of (nearly) 180 degrees, or a sharp one, just beyond or just inside the circle.
TEST(DiscPolygonOverlap, VertexThatJustPokesIntoTheDisc)
{
  PieceErrors e;
  for (const double bend : {0., 1e-15, 1e-9, 1e-6, 1e-3, 1., 5., 30.})
    for (const double side : {1., -1.})
      {
        // side 1: the disc rests on the vertex (0, 0) within the cell; side -1: it touches it from outside
        const ConvexPolygon   polygon{{{{{-2., bend}}, {{0., 0.}}, {{3., bend}}, {{0.5, 40.}}}}, 4};
        const PreparedPolygon cell(polygon);
        for (int dx = -3; dx <= 3; ++dx)
          for (int ulp = -20; ulp <= 20; ++ulp)
            for (const double step : {0x1p-53, 1e-12, 1e-9, 1e-5})
              e.add({{{dx * 1e-9, side * (1. + ulp * step)}}, 1.}, polygon, cell, 1.);
      }
  EXPECT_GT(e.n_slivers, 100u);
  EXPECT_LE(e.area, 1e-14);
  EXPECT_LE(e.first, 1e-14);
  EXPECT_LE(e.second, 1e-14);
  EXPECT_LE(e.outside, 1e-14);
}
