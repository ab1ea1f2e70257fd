#pragma once

#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/vans_problem.h>

#include <deal.II/base/tensor.h>

namespace alluvium::fluid
{
  /** What a kind of boundary condition looks at when a scene is set up. */
  template <int dim>
  struct BoundaryScene
  {
    const FluidSpace<dim>                             &space;
    const BoundaryConditions<dim>                     &conditions;
    dealii::types::boundary_id                         id;
    const typename BoundaryConditions<dim>::Condition &condition; // of this boundary
    const FluidProperties                             &fluid;
    dealii::Tensor<1, dim>                             gravity; // [m/s^2]
    double                                             size;    // of the domain, the longest side [m]
    double                                             flux;    // out of the domain, of a given velocity [m^2/s]
  };

  /** Call @p action(a, b) with the ends of each owned part of a face that is this boundary. */
  template <int dim, typename Action>
  void for_each_face(const BoundaryScene<dim> &scene, const Action &action)
  {
    for (const auto &cell : scene.space.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              const auto &a = cell->face(f)->vertex(0), &b = cell->face(f)->vertex(1);
              for (const auto &part : scene.space.boundary().divide_face(cell->face(f)->boundary_id(), a, b))
                if (part.id == scene.id)
                  action(dealii::Point<dim>((1. - part.begin) * a + part.begin * b),
                         dealii::Point<dim>((1. - part.end) * a + part.end * b));
            }
  }
} // namespace alluvium::fluid
