#pragma once

#include <deal.II/distributed/shared_tria.h>

namespace alluvium::mesh
{
  /** Give every rank as many of the active cells, by cutting the longer side of what is to be shared, again and again.
   */
  template <int dim>
  void partition_by_bisection(dealii::parallel::shared::Triangulation<dim> &triangulation);
} // namespace alluvium::mesh
