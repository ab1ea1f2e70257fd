#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <vector>

namespace alluvium::mesh
{
  /** A side of a cell on the boundary. */
  struct Side
  {
    unsigned int               a, b; // vertices
    dealii::types::boundary_id id;
  };

  /**
   * The boundary of @p triangulation, which consists of @p sides, with those that continue each other straight on
   * joined. @return the ends of each [m]; @p side_ids receives its boundary.
   */
  template <int dim>
  std::vector<std::array<dealii::Point<dim>, 2>> straight_sides(const dealii::Triangulation<dim>        &triangulation,
                                                                const std::vector<Side>                 &sides,
                                                                std::vector<dealii::types::boundary_id> &side_ids);
} // namespace alluvium::mesh
