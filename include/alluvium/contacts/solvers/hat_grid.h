#pragma once

#include <array>
#include <cstddef>

namespace alluvium::contacts
{
  /** Bilinear hat functions on a grid of equal rectangles over a box that may be periodic. */
  class HatGrid
  {
  public:
    /** The four hats that are not zero at a point, some of which may be the same where the box is a period wide. */
    struct Hats
    {
      std::size_t                cell;
      std::array<std::size_t, 4> node;   // lower left, lower right, upper left, upper right
      std::array<double, 4>      value;  // [-]
      std::array<double, 4>      dx, dy; // gradient [1/m]
    };

    /** From @p lower to @p upper [m], in cells of about @p size [m], at most @p most of them in a direction; a positive
     * @p period [m] stands for the length of the box. */
    void set(const std::array<double, 2> &lower,
             const std::array<double, 2> &upper,
             const std::array<double, 2> &period,
             double                       size,
             std::size_t                  most);

    std::size_t n_nodes() const { return n[0] * n[1]; }
    std::size_t n_cells() const { return n_cells(0) * n_cells(1); }

    /** The nodes at the corners of a cell. */
    std::array<std::size_t, 4> nodes(const std::size_t cell) const
    {
      return corners({{cell % n_cells(0), cell / n_cells(0)}});
    }

    /** Points outside count as on the boundary. */
    Hats at(double x, double y) const;

    /** Number of a node in an order in which those of a cell are no farther apart than band_width(). */
    std::size_t position(const std::size_t node) const
    {
      const unsigned int inner = 1 - outer;
      return fold(outer, outer == 0 ? node % n[0] : node / n[0]) * n[inner] +
             fold(inner, inner == 0 ? node % n[0] : node / n[0]);
    }
    std::size_t band_width() const { return width(outer); }

  private:
    std::array<double, 2>      low{}, size{{1., 1.}}; // of a cell [m]
    std::array<std::size_t, 2> n{{2, 2}};             // nodes
    std::array<bool, 2>        periodic{};
    unsigned int               outer = 1; // direction of which the numbers change last

    std::size_t n_cells(const unsigned int d) const { return periodic[d] ? n[d] : n[d] - 1; }

    std::array<std::size_t, 4> corners(const std::array<std::size_t, 2> &first) const
    {
      const std::size_t x = first[0], y = first[1] * n[0];
      const std::size_t right = x + 1 < n[0] ? x + 1 : 0, top = first[1] + 1 < n[1] ? y + n[0] : 0;
      return {{y + x, y + right, top + x, top + right}};
    }

    /** A ring is flattened: 0, n - 1, 1, n - 2, ..., in which neighbours are at most two apart. */
    std::size_t fold(const unsigned int d, const std::size_t k) const
    {
      return !periodic[d] ? k : 2 * k < n[d] ? 2 * k : 2 * (n[d] - 1 - k) + 1;
    }
    std::size_t step(const unsigned int d) const { return n[d] < 3 || !periodic[d] ? (n[d] > 1 ? 1 : 0) : 2; }
    std::size_t width(const unsigned int d) const { return step(d) * n[1 - d] + step(1 - d); }
  };
} // namespace alluvium::contacts
