#pragma once

#include <array>
#include <string>

namespace alluvium::run
{
  struct Model;

  struct Place
  {
    std::array<double, 2> point{}; // [m]
    std::string           name;    // of the boundary that is nearest, or of the grain
  };

  /** Where the fluid is fastest, or a field is not finite. Collective. */
  Place fastest_fluid(const Model &model);

  /** The fastest grain, or one whose position or velocity is not finite. The same on all ranks. */
  Place fastest_grain(const Model &model);

  /** The boundary next to @p point, with its distance, as words. Collective. */
  std::string nearest_boundary(const Model &model, const std::array<double, 2> &point);
} // namespace alluvium::run
