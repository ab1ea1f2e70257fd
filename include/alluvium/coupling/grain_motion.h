#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <vector>

namespace alluvium::coupling
{
  /** How grains moved in a step: mean velocity [d][n] [m/s], spin at its end [n] [rad/s]. */
  struct GrainMotion
  {
    grains::Components  velocity;
    std::vector<double> omega;
  };
} // namespace alluvium::coupling
