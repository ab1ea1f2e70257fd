#pragma once

#include <alluvium/geometry/convex_polygon.h>

#include <vector>

namespace alluvium::geometry
{
  /**
   * Axis-parallel rectangles that do not overlap, of any sizes (hanging nodes): the lines that their sides lie on, each
   * once, and which cell lies where between them. What costs when a disc is cut then costs once a line, not once a
   * cell.
   */
  class RectangleGrid
  {
  public:
    RectangleGrid() = default;

    /**
     * Empty unless all of @p polygons are such rectangles, their first vertex lower left, to 1e-11 of their sides, and
     * the lines do not make far more gaps than there are cells.
     */
    explicit RectangleGrid(const std::vector<PreparedPolygon> &polygons);

    bool empty() const { return cells.empty(); }
    /** Empty because of too many gaps? */
    bool is_non_tensor() const { return empty() && lines[0].size() > 1; }

    /** Its sides lie on lines [direction][first, last]. */
    struct Cell
    {
      std::array<std::array<int, 2>, 2> line;
      Point2                            lower, inverse_length; // [m], [1/m]
    };
    const Cell &cell(const unsigned index) const { return cells[index]; }

    double line(const unsigned direction, const int index) const { return lines[direction][index]; } // [m]
    int    n_lines(const unsigned direction) const { return lines[direction].size(); }

    /** Call @p action(index) for every cell that meets the open box, from left to right and from below. */
    template <typename Action>
    void for_each_cell(const Point2 &lower, const Point2 &upper, const Action &action) const
    {
      std::array<int, 2> begin, end; // gaps: i lies between lines i and i + 1
      for (unsigned d = 0; d < 2; ++d)
        {
          begin[d] = gap(d, lower[d]);
          for (end[d] = begin[d]; end[d] < n_lines(d) - 1 && lines[d][end[d]] < upper[d];)
            ++end[d];
        }
      for (int j = begin[1]; j < end[1]; ++j)
        for (int i = begin[0]; i < end[0];)
          {
            const int c = cell_at[j * (lines[0].size() - 1) + i];
            if (c < 0)
              {
                ++i;
                continue;
              }
            // of the rows that a cell extends over, the lowest one counts
            if (j == begin[1] || cells[c].line[1][0] == j)
              action(static_cast<unsigned>(c));
            i = cells[c].line[0][1];
          }
    }

  private:
    /** The gap that has @p x, or the nearest one. */
    int gap(const unsigned direction, const double x) const;

    std::array<std::vector<double>, 2> lines; // rising
    std::vector<Cell>                  cells;
    std::vector<int>                   cell_at; // [gap in y][gap in x]; -1: none
  };
} // namespace alluvium::geometry
