#pragma once

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/output/field_series.h>

namespace alluvium::output
{
  /**
   * Add the fluid to @p series: velocity [m/s], total and reduced pressure [Pa] and void fraction. The total pressure
   * is the reduced one + @p hydrostatic_gradient.x + @p datum, rho g [Pa/m] and [Pa]. Collective.
   */
  void write_fluid(FieldSeries                &series,
                   const fluid::FluidSpace<2> &space,
                   const fluid::BlockVector   &solution,
                   const fluid::Vector        &void_fraction,
                   const dealii::Tensor<1, 2> &hydrostatic_gradient,
                   const double                datum,
                   const double                time);
} // namespace alluvium::output
