#pragma once

#include <alluvium/grains/grain_arrays.h>

namespace alluvium::grains
{
  /**
   * Packing fraction inside a bed: area of the discs over that of the rectangle they are in, without three diameters at
   * each side and below the surface (the height below which 98 % of the centres are), where walls and surface make it
   * looser. 0 if nothing is left then. Exact to about 1e-4.
   */
  double inner_packing_fraction(const GrainArrays &grains);
} // namespace alluvium::grains
