#pragma once

#include <alluvium/mesh/box.h>

#include <cstddef>
#include <vector>

namespace alluvium::mesh
{
  /**
   * What a cell costs a fluid step, from the grains that it is likely to be cut by: for a partition of the mesh that
   * shares work, not cells. Grains are counted on a raster, so that asking costs nothing.
   */
  class CellWeights
  {
  public:
    /** Count discs at (@p x, @p y) [m] that reach @p reach [m] far. */
    void count(const std::vector<double> &x, const std::vector<double> &y, const double reach);

    /** Number of discs whose middle is near enough to @p box to reach into it, give or take those at its corners. */
    double n_near(const Box &box) const;

    /** What cells cost that have @p n_near grains near them, counted in each: 1000 for one cell without grains. */
    static double cost(const double n_cells, const double n_near);

    /** Cost of a cell as large as @p box. */
    unsigned int weight(const Box &box) const;

  private:
    double                     reach = 0., side = 1.; // [m]
    std::array<double, 2>      lower{};
    std::array<std::size_t, 2> n{};
    std::vector<double>        sum; // of the counts below and to the left, (n[0] + 1) (n[1] + 1) values
  };
} // namespace alluvium::mesh
