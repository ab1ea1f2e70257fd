#include <alluvium/geometry/grid_cutter.h>
#include <alluvium/geometry/smooth_disc_overlap.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "meshes.h"

using namespace overlap_test;

namespace
{
  PreparedPolygon rectangle(const double x0, const double y0, const double x1, const double y1)
  {
    return PreparedPolygon(ConvexPolygon{{{{{x0, y0}}, {{x1, y0}}, {{x1, y1}}, {{x0, y1}}}}, 4});
  }

  /** Squares, of which every third is cut into four rectangles, and a hole. */
  std::vector<PreparedPolygon> hanging_nodes(const unsigned n, const double h)
  {
    std::vector<PreparedPolygon> cells;
    for (unsigned j = 0; j < n; ++j)
      for (unsigned i = 0; i < n; ++i)
        {
          const double x0 = i * h, x1 = (i + 1) * h, y0 = j * h, y1 = (j + 1) * h;
          const double x = 0.5 * (x0 + x1), y = 0.3 * y0 + 0.7 * y1;
          if (i == n / 3 && j == n / 2)
            continue;
          if ((i + 2 * j) % 3 > 0)
            cells.push_back(rectangle(x0, y0, x1, y1));
          else
            for (const auto &c :
                 {rectangle(x0, y0, x, y), rectangle(x, y0, x1, y), rectangle(x0, y, x, y1), rectangle(x, y, x1, y1)})
              cells.push_back(c);
        }
    return cells;
  }

  /** The piece of @p disc in each of @p n_cells cells; at most one. */
  std::vector<std::optional<GridPiece>> pieces_of_cells(const Disc &disc, GridCutter &cutter, const std::size_t n_cells)
  {
    std::vector<GridPiece> pieces;
    cutter.cut(disc, {}, pieces);
    std::vector<std::optional<GridPiece>> of_cell(n_cells);
    for (const GridPiece &p : pieces)
      {
        EXPECT_FALSE(of_cell[p.cell].has_value());
        of_cell[p.cell] = p;
      }
    return of_cell;
  }

  /** Largest differences from overlap() in area and first moments over r^2 and r^2 (r + |x|), in the means of xi, eta
   * and xi eta of pieces above 1e-6 of disc or cell, and in the sum of areas. */
  struct Differences
  {
    double   area = 0., first = 0., mean = 0., sum = 0.;
    unsigned n = 0, n_small = 0, n_full = 0;

    void add(const Disc &disc, GridCutter &cutter, const std::vector<PreparedPolygon> &cells)
    {
      const auto update = [](double &worst, const double error) {
        if (!(std::abs(error) <= worst))
          worst = std::abs(error);
      };
      const auto   of_cell = pieces_of_cells(disc, cutter, cells.size());
      const double r       = disc.radius;
      double       all = 0., exact = 0.;
      for (unsigned c = 0; c < cells.size(); ++c)
        {
          const Overlap o  = overlap(disc, cells[c]);
          const double  lx = cells[c].upper[0] - cells[c].lower[0], ly = cells[c].upper[1] - cells[c].lower[1];
          const double  xi = (o.centroid[0] - cells[c].lower[0]) / lx, eta = (o.centroid[1] - cells[c].lower[1]) / ly;
          const auto   &p = of_cell[c];
          const double  a = p ? p->area : 0.;
          exact += o.area;
          all += a;
          update(area, (a - o.area) / (r * r));
          if (!p)
            continue;
          ++n;
          n_small += a < 1e-6 * std::min(r * r, cells[c].area);
          EXPECT_LT(a, cells[c].area * (1. + 1e-12));
          n_full += a == cells[c].area;
          update(first, (a * p->xi - o.area * xi) * lx / (r * r * (r + cells[c].upper[0])));
          update(first, (a * p->eta - o.area * eta) * ly / (r * r * (r + cells[c].upper[1])));
          if (a > 1e-6 * std::min(r * r, cells[c].area))
            {
              update(mean, p->xi - xi);
              update(mean, p->eta - eta);
              update(mean, p->product - xi * eta - o.second_moments[1] / (o.area * lx * ly));
            }
          // no shape function below zero
          for (const double phi :
               {1. - p->xi - p->eta + p->product, p->xi - p->product, p->eta - p->product, p->product})
            EXPECT_GE(phi, -1e-16);
          EXPECT_GE(a, 0.);
        }
      update(sum, (all - exact) / (r * r));
    }
  };

  /** Largest differences from smooth_overlap() in weight and in the moments x, y and xy about the disc's centre, over
   * r^2, r^2 l and r^2 l^2 with l = r + |x|, and of the whole disc from pi r^2 where it lies in the cells. */
  struct SmoothDifferences
  {
    double   weight = 0., first = 0., second = 0., sum = 0.;
    unsigned n = 0, n_whole_cells = 0, n_small = 0;

    void add(const Disc &disc, GridCutter &cutter, const std::vector<PreparedPolygon> &cells, const bool covered)
    {
      const auto   of_cell = pieces_of_cells(disc, cutter, cells.size());
      const double r       = disc.radius;
      double       all     = 0.;
      for (unsigned c = 0; c < cells.size(); ++c)
        {
          const Overlap         o    = smooth_overlap(disc, cells[c]);
          const auto           &p    = of_cell[c];
          std::array<double, 4> mine = {{0., 0., 0., 0.}};
          if (p)
            {
              const double lx = cells[c].upper[0] - cells[c].lower[0], ly = cells[c].upper[1] - cells[c].lower[1];
              const double x0 = cells[c].lower[0] - disc.centre[0], y0 = cells[c].lower[1] - disc.centre[1];
              mine = {{p->area,
                       p->area * (x0 + p->xi * lx),
                       p->area * (y0 + p->eta * ly),
                       p->area * (x0 * y0 + x0 * ly * p->eta + y0 * lx * p->xi + lx * ly * p->product)}};
              ++n;
              n_small += p->area < 1e-6 * std::min(r * r, cells[c].area);
              const double far_x = std::max(-x0, x0 + lx), far_y = std::max(-y0, y0 + ly);
              n_whole_cells += far_x * far_x + far_y * far_y < r * r;
              for (const double phi :
                   {1. - p->xi - p->eta + p->product, p->xi - p->product, p->eta - p->product, p->product})
                EXPECT_GE(phi, -3e-16);
              EXPECT_GT(p->area, 0.);
            }
          all += mine[0];
          const double l = r + std::max(cells[c].upper[0], cells[c].upper[1]);
          weight         = std::max(weight, std::abs(mine[0] - o.area) / (r * r));
          first          = std::max({first,
                                     std::abs(mine[1] - o.area * o.arm[0]) / (r * r * l),
                                     std::abs(mine[2] - o.area * o.arm[1]) / (r * r * l)});
          second =
            std::max(second, std::abs(mine[3] - o.second_moments[1] - o.area * o.arm[0] * o.arm[1]) / (r * r * l * l));
        }
      if (covered)
        sum = std::max(sum, std::abs(all / (r * r) - M_PI));
    }
  };

  void compare(
    const char *name, const std::vector<PreparedPolygon> &cells, const Mesh &places, const double h, const bool hole)
  {
    const RectangleGrid grid(cells);
    ASSERT_FALSE(grid.empty());
    GridCutter cutter(grid, cells, DiscWeight::top_hat), smooth_cutter(grid, cells, DiscWeight::parabolic);
    Rng        rng(11);
    for (const double ratio : {8., 4., 2., 1., 0.5, 0.25})
      {
        const double      r = h / (2 * ratio);
        Differences       d;
        SmoothDifferences s;
        for (unsigned i = 0; i < 1500; ++i)
          for (const Disc &disc : {random_disc(places, r, rng), adversarial_disc(places, r, rng)})
            {
              d.add(disc, cutter, cells);
              const double x = disc.centre[0], y = disc.centre[1], end = places.n * h;
              s.add(disc, smooth_cutter, cells, !hole && std::min({x, y, end - x, end - y}) > r);
            }
        std::printf("%-8s h/d %-5g area %.1e  first moments %.1e  means %.1e  sum %.1e, %u pieces, %u small\n",
                    name,
                    ratio,
                    d.area,
                    d.first,
                    d.mean,
                    d.sum,
                    d.n,
                    d.n_small);
        std::printf("%-8s smooth    weight %.1e  first moments %.1e  xy %.1e  sum %.1e, %u pieces, %u small\n",
                    "",
                    s.weight,
                    s.first,
                    s.second,
                    s.sum,
                    s.n,
                    s.n_small);
        EXPECT_LE(d.area, 1e-14);
        EXPECT_LE(d.first, 1e-14);
        EXPECT_LE(d.mean, 1e-10);
        EXPECT_LE(d.sum, 1e-14);
        EXPECT_GT(d.n_small, 0u);
        EXPECT_LE(s.weight, 2e-13); // pieces of 1e-13 may be dropped by one and not by the other
        EXPECT_LE(s.first, 1e-14);
        EXPECT_LE(s.second, 1e-14);
        EXPECT_LE(s.sum, 1e-12);
        EXPECT_GT(s.n_small, 0u);
        if (ratio < 0.3)
          {
            EXPECT_GT(d.n_full, d.n / 10);
            EXPECT_GT(s.n_whole_cells, s.n / 10);
          }
      }
  }
} // namespace


// The same pieces as overlap()'s and smooth_overlap()'s.
TEST(GridCutter, AgreesWithTheGeneralOverlaps)
{
  const double h = 0.0173;
  const Mesh   mesh(Shape::squares, 16, h);
  compare("squares", mesh.cells, mesh, h, false);
  compare("hanging", hanging_nodes(16, h), mesh, h, true);
}


TEST(GridCutter, CutsWhatIsWanted)
{
  const Mesh          mesh(Shape::squares, 8, 1.);
  const RectangleGrid grid(mesh.cells);
  for (const DiscWeight weight : {DiscWeight::top_hat, DiscWeight::parabolic})
    {
      GridCutter             cutter(grid, mesh.cells, weight);
      std::vector<GridPiece> all, some;
      const Disc             disc{{{4.1, 3.9}}, 1.7};
      cutter.cut(disc, {}, all);
      std::vector<std::uint8_t> wanted(mesh.cells.size(), 0);
      for (unsigned c = 0; c < wanted.size(); c += 2)
        wanted[c] = 1;
      cutter.cut(disc, wanted, some);
      std::size_t found = 0;
      for (const GridPiece &p : all)
        if (wanted[p.cell])
          {
            ASSERT_LT(found, some.size());
            EXPECT_EQ(some[found].cell, p.cell);
            EXPECT_EQ(some[found].area, p.area);
            ++found;
          }
      EXPECT_EQ(found, some.size());
      EXPECT_GT(found, 4u);
    }
}


// sides that all lie on lines of their own would make a million gaps of a thousand cells
TEST(GridCutter, TooManyLines)
{
  std::vector<PreparedPolygon> cells;
  for (unsigned i = 0; i < 1000; ++i)
    cells.push_back(rectangle(i, i, i + 0.5, i + 0.5));
  EXPECT_TRUE(RectangleGrid(cells).empty());
  EXPECT_TRUE(RectangleGrid(cells).is_non_tensor());
  cells.resize(100);
  EXPECT_FALSE(RectangleGrid(cells).empty());
  EXPECT_FALSE(RectangleGrid(cells).is_non_tensor());
}


TEST(GridCutter, OtherCellsMakeNoGrid)
{
  EXPECT_TRUE(RectangleGrid().empty());
  EXPECT_TRUE(RectangleGrid(Mesh(Shape::triangles, 3, 1.).cells).empty());
  EXPECT_FALSE(RectangleGrid(Mesh(Shape::triangles, 3, 1.).cells).is_non_tensor());
  EXPECT_TRUE(RectangleGrid(Mesh(Shape::distorted, 3, 1.).cells).empty());
  // turned by a quarter: the first vertex is not the lower left one
  const PreparedPolygon turned(ConvexPolygon{{{{{1., 0.}}, {{1., 1.}}, {{0., 1.}}, {{0., 0.}}}}, 4});
  EXPECT_TRUE(RectangleGrid({turned}).empty());
  EXPECT_FALSE(RectangleGrid({rectangle(0., 0., 1., 2.)}).empty());
}
