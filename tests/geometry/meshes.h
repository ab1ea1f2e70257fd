#pragma once

#include <alluvium/geometry/disc_polygon_overlap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

/** Meshes of the square [0, N h]^2, and discs placed in them at random or where an overlap code is likely to stumble.
 */
namespace overlap_test
{
  using namespace alluvium::geometry;
  using Rng = std::mt19937_64;

  inline double uniform(Rng &rng, const double a = 0., const double b = 1.)
  {
    return a + (b - a) * static_cast<double>(rng() >> 11) * 0x1p-53;
  }

  enum class Shape
  {
    squares,
    triangles,
    distorted
  };

  inline const char *name(const Shape shape)
  {
    return shape == Shape::squares ? "squares" : shape == Shape::triangles ? "triangles" : "distorted";
  }

  struct Mesh
  {
    /** @p n x n nodes' cells of size @p h [m]; `distorted` moves every node by up to 0.24 h, `triangles` cut squares at
     * random diagonals. */
    Mesh(const Shape shape, const unsigned n, const double h, const std::uint64_t seed = 1)
      : n(n)
      , h(h)
      , per_square(shape == Shape::triangles ? 2 : 1)
    {
      Rng                 rng(seed);
      std::vector<Point2> nodes;
      for (unsigned j = 0; j <= n; ++j)
        for (unsigned i = 0; i <= n; ++i)
          {
            nodes.push_back({{i * h, j * h}});
            if (shape == Shape::distorted)
              for (double &c : nodes.back())
                c += uniform(rng, -0.24 * h, 0.24 * h);
          }
      for (unsigned j = 0; j < n; ++j)
        for (unsigned i = 0; i < n; ++i)
          {
            const Point2 &a = nodes[j * (n + 1) + i], &b = nodes[j * (n + 1) + i + 1];
            const Point2 &c = nodes[(j + 1) * (n + 1) + i + 1], &d = nodes[(j + 1) * (n + 1) + i];
            const auto    triangle = [](const Point2 &p, const Point2 &q, const Point2 &s) {
              return ConvexPolygon{{{p, q, s, {{0., 0.}}}}, 3};
            };
            if (shape != Shape::triangles)
              polygons.push_back(ConvexPolygon{{{a, b, c, d}}, 4});
            else if (rng() & 1)
              {
                polygons.push_back(triangle(a, b, c));
                polygons.push_back(triangle(c, d, a));
              }
            else
              {
                polygons.push_back(triangle(b, c, d));
                polygons.push_back(triangle(d, a, b));
              }
          }
      for (const ConvexPolygon &polygon : polygons)
        cells.emplace_back(polygon);
    }

    /** Call f(index of cell) for all cells that a disc may touch, and a ring more. */
    template <class F>
    void for_each_near(const Disc &disc, F &&f) const
    {
      const auto clamp = [&](const double c) {
        return static_cast<unsigned>(std::min(n - 1., std::max(0., std::floor(c / h))));
      };
      const double reach = disc.radius + 1.5 * h;
      for (unsigned j = clamp(disc.centre[1] - reach); j <= clamp(disc.centre[1] + reach); ++j)
        for (unsigned i = clamp(disc.centre[0] - reach); i <= clamp(disc.centre[0] + reach); ++i)
          for (unsigned k = 0; k < per_square; ++k)
            f((j * n + i) * per_square + k);
    }

    unsigned                     n;
    double                       h;
    unsigned                     per_square;
    std::vector<ConvexPolygon>   polygons;
    std::vector<PreparedPolygon> cells;
  };

  /** A disc of radius @p r well inside the mesh, anywhere. */
  inline Disc random_disc(const Mesh &mesh, const double r, Rng &rng)
  {
    const double margin = r + 1.5 * mesh.h, length = mesh.n * mesh.h;
    return {{{uniform(rng, margin, length - margin), uniform(rng, margin, length - margin)}}, r};
  }

  /**
   * A disc of radius @p r well inside the mesh: a vertex on the circle, two of them, a tangent edge (anywhere, or
   * touched at its end), the centre on a vertex or an edge; as it is, or moved by an ulp or by 1e-9 r.
   */
  inline Disc adversarial_disc(const Mesh &mesh, const double r, Rng &rng)
  {
    const Disc     somewhere = random_disc(mesh, r, rng);
    const unsigned square    = static_cast<unsigned>(somewhere.centre[1] / mesh.h) * mesh.n +
                            static_cast<unsigned>(somewhere.centre[0] / mesh.h);
    const ConvexPolygon &cell = mesh.polygons[square * mesh.per_square + rng() % mesh.per_square];
    const unsigned       i    = rng() % cell.n;
    const Point2         a = cell.vertex[i], b = cell.vertex[(i + 1) % cell.n];
    const double         dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
    const double         side = (rng() & 1) ? 1. : -1.;
    const double         nx = -side * dy / length, ny = side * dx / length;

    Disc disc{a, r};
    switch (rng() % 8)
      {
          case 0: // a vertex on the circle, exactly where that can be
          {
            static const double directions[8][2] = {
              {1., 0.}, {0., 1.}, {-1., 0.}, {0., -1.}, {.6, .8}, {-.8, .6}, {-.6, -.8}, {.8, -.6}};
            const auto &d = directions[rng() % 8];
            disc.centre   = {{a[0] + r * d[0], a[1] + r * d[1]}};
            break;
          }
          case 1: {
            const double angle = uniform(rng, 0., 2 * M_PI);
            disc.centre        = {{a[0] + r * std::cos(angle), a[1] + r * std::sin(angle)}};
            break;
          }
          case 2: // both ends of an edge, or the nearest thing to it
          {
            const double w = std::sqrt(std::max(0., r * r - length * length / 4));
            disc.centre    = {{(a[0] + b[0]) / 2 + w * nx, (a[1] + b[1]) / 2 + w * ny}};
            break;
          }
          case 3: // tangent
          {
            const double t = uniform(rng);
            disc.centre    = {{a[0] + t * dx + r * nx, a[1] + t * dy + r * ny}};
            break;
          }
        case 4: // tangent at a vertex
          disc.centre = {{a[0] + r * nx, a[1] + r * ny}};
          break;
        case 5: // centre on a vertex
          break;
        case 6: // centre on an edge
          disc.centre = {{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}};
          break;
          case 7: {
            const double t = uniform(rng);
            disc.centre    = {{a[0] + t * dx, a[1] + t * dy}};
            break;
          }
      }
    const unsigned shift = rng() % 3;
    if (shift > 0)
      for (double &c : disc.centre)
        {
          const int sign = static_cast<int>(rng() % 3) - 1;
          if (shift == 2)
            c += sign * 1e-9 * r;
          else if (sign != 0)
            c = std::nextafter(c, sign * std::numeric_limits<double>::infinity());
        }
    if (rng() % 8 == 0)
      disc.radius = std::nextafter(r, (rng() & 1) ? 0. : 2 * r);
    const double margin = 1.01 * r + 1.5 * mesh.h, far = mesh.n * mesh.h - margin;
    const bool   covered =
      std::min(disc.centre[0], disc.centre[1]) >= margin && std::max(disc.centre[0], disc.centre[1]) <= far;
    return covered ? disc : adversarial_disc(mesh, r, rng);
  }
} // namespace overlap_test
