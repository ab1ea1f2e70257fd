#pragma once

#include <alluvium/geometry/upright.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::grains
{
  /** The bed as a body, wherever it stands: between its faces, as wide as its grains reach. */
  struct BedPacking
  {
    double width       = 0.; // of the columns that have a bed [m]
    double height      = 0.; // mean, from their bottoms to their tops [m]
    double solid       = 0.; // of the grains in them, by contact radius [m^2]
    double fluid_solid = 0.; // the same by fluid radius [m^2]

    double area() const { return width * height; }
    /** Packing fraction by contact radius, 0 without a bed. */
    double fraction() const { return solid > 0. ? solid / area() : 0.; }
    /** The same as the fluid sees it. */
    double fluid_fraction() const { return solid > 0. ? fluid_solid / area() : 0.; }
  };

  /**
   * Measure the bed of @p grains between @p left and @p right [m], across @p upright, in the columns of
   * find_bed_faces(). A column at the end of a bed counts as far as its grains reach, if they leave more than a mean
   * diameter free.
   */
  BedPacking
  measure_bed(const grains::GrainArrays &grains, double left, double right, const geometry::Upright &upright = {});
} // namespace alluvium::grains
