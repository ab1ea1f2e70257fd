#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <functional>

namespace alluvium::fluid
{
  /**
   * Average along the horizontal line at height @p y of a function of u [m/s] and the reduced pressure p [Pa], taken at
   * the middle of the line's piece in each cell. On a line between cells the upper cell counts, on the top boundary the
   * lower one. NaN if the line misses the mesh. Collective.
   */
  template <int dim>
  double line_average(const FluidSpace<dim>                                                         &space,
                      const BlockVector                                                             &solution,
                      const double                                                                   y,
                      const std::function<double(const std::array<double, dim> &u, const double p)> &function);
} // namespace alluvium::fluid
