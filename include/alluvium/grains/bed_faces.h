#pragma once

#include <alluvium/geometry/upright.h>
#include <alluvium/grains/grain_arrays.h>

#include <array>
#include <vector>

namespace alluvium::grains
{
  /**
   * Where the grains' bed begins and ends, looked for in columns because a bed need not be level. The top of a column
   * is the height y + r above which there is a quarter of a layer of grains (area 0.25 d times the column's width), so
   * a few grains that fly above the bed do not move it; the bottom likewise with y - r. That quarter of a layer lies
   * within 3 d: grains that rain far from one another are no bed. A column without as many has none. Columns stand as
   * `upright` says: left and right are its `across`, bottom and top its heights.
   */
  struct BedFaces
  {
    struct Column
    {
      double left, right; // [m]
      double bottom, top; // [m]
    };
    std::vector<Column> columns; // those with a bed, from left to right
    geometry::Upright   upright;

    bool empty() const { return columns.empty(); }

    /** Lowest bottom and highest top of all columns [m]; not for an empty bed. */
    double bottom() const;
    double top() const;

    /** Mean distance of the tops from the bottoms [m], 0 for an empty bed. */
    double mean_height() const;

    /** Distance [m] of the box from @p lower to @p upper to the nearest column's top, or bottom; infinite without a
     * bed. */
    double distance_to_top(const std::array<double, 2> &lower, const std::array<double, 2> &upper) const;
    double distance_to_bottom(const std::array<double, 2> &lower, const std::array<double, 2> &upper) const;
  };

  /** Mean contact diameter of @p grains [m], 0 without grains. */
  double mean_diameter(const grains::GrainArrays &grains);

  /** @p grains with their centres at (across, height) of @p upright; the rest is as it was. */
  grains::GrainArrays turned(const grains::GrainArrays &grains, const geometry::Upright &upright);

  /**
   * Find the faces in columns about 8 mean diameters wide between @p left and @p right [m], coordinates across @p
   * upright (x where gravity is along -y).
   */
  BedFaces
  find_bed_faces(const grains::GrainArrays &grains, double left, double right, const geometry::Upright &upright = {});
} // namespace alluvium::grains
