#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <functional>

namespace alluvium::observers
{
  /**
   * Average along the line on which coordinate @p axis is @p level (horizontal, unless told) of a function of u [m/s]
   * and the reduced pressure p [Pa], taken at the middle of the line's piece in each cell. On a line between cells the
   * upper cell counts, on the top boundary the lower one. NaN if the line misses the mesh. Collective.
   */
  template <int dim>
  double line_average(const fluid::FluidSpace<dim>                                                  &space,
                      const fluid::BlockVector                                                      &solution,
                      const double                                                                   level,
                      const std::function<double(const std::array<double, dim> &u, const double p)> &function,
                      const unsigned int                                                             axis = 1);

  /** Mean of @p function of velocity [m/s] and reduced pressure [Pa] over boundary @p id. Collective. */
  template <int dim>
  double boundary_average(const fluid::FluidSpace<dim>                                                  &space,
                          const fluid::BlockVector                                                      &solution,
                          const dealii::types::boundary_id                                               id,
                          const std::function<double(const std::array<double, dim> &u, const double p)> &function);
} // namespace alluvium::observers
