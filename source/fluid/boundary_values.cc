#include <alluvium/fluid/boundary_values.h>
#include <alluvium/fluid/cell_order.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>

#include <limits>

namespace alluvium::fluid
{
  using namespace dealii;

  template <int dim>
  std::vector<geometry::FacePart>
  BoundaryValues<dim>::divide_face(const types::boundary_id id, const Point<dim> &a, const Point<dim> &b) const
  {
    return geometry::divide_face(parts, id, {{a[0], a[1]}}, {{b[0], b[1]}});
  }


  template <int dim>
  void BoundaryValues<dim>::reinit(const FluidDofs<dim> &fluid_dofs, const BoundaryConditions<dim> &boundary_conditions)
  {
    dofs = &fluid_dofs;
    const BoundaryNodes<dim> boundary(fluid_dofs, *this, boundary_conditions);
    inflow         = boundary.inflow;
    inflow_at      = boundary.inflow_nodes();
    boundary_faces = boundary.faces;
    open_ids.clear();
    for (const auto &[id, condition] : boundary_conditions.all())
      if (condition.kind->gives_pressure())
        open_ids.push_back(id);
    all_constraints.clear();
    all_constraints.reinit(fluid_dofs.relevant_dofs());
    all_constraints.merge(fluid_dofs.hanging_constraints());
    boundary_dofs = boundary.constrain(fluid_dofs.hanging_constraints(), all_constraints);
    if (boundary_conditions.pins_pressure())
      {
        const types::global_dof_index first_pressure = fluid_dofs.first_pressure();
        if (fluid_dofs.relevant_dofs().is_element(first_pressure) && !all_constraints.is_constrained(first_pressure))
          all_constraints.add_line(first_pressure);
      }
    all_constraints.close();
    find_weights(boundary, boundary_conditions);
  }


  template <int dim>
  void BoundaryValues<dim>::find_weights(const BoundaryNodes<dim>      &nodes,
                                         const BoundaryConditions<dim> &boundary_conditions)
  {
    const unsigned int n_nodes = dofs->n_nodes_per_cell();
    boundary_weights.clear();
    std::vector<types::global_dof_index> cell_nodes(n_nodes);
    for (const auto &[id, condition] : boundary_conditions.all())
      {
        Vector weight = dofs->make_nodal_field();
        for (const auto index : nodes.nodes_of(id))
          if (dofs->nodal_partitioner().in_local_range(index))
            weight(index) = nodes.share(index, id);
        check_user(!condition.kind->gives_pressure() || weight.linfty_norm() > 0.,
                   "Boundary conditions/Pressure: no node of the fluid's mesh lies on '" + condition.name +
                     "': it is narrower than a cell there. Make the cells smaller, or give a velocity, whose flux is "
                     "exact on cells of any size.");
        dofs->interpolate_hanging_nodes(weight);
        auto        &list       = boundary_weights[id];
        unsigned int cell_index = 0;
        for (const auto &cell : ordered_cells(dofs->nodal_dof_handler()))
          if (cell->is_locally_owned())
            {
              cell->get_dof_indices(cell_nodes);
              BoundaryWeight w{cell_index, {}};
              double         sum = 0.;
              for (unsigned int v = 0; v < n_nodes; ++v)
                sum += w.weight[v] = weight(cell_nodes[v]);
              if (sum > 0.)
                list.push_back(w);
              ++cell_index;
            }
      }
  }


  template <int dim>
  template <typename Action>
  void BoundaryValues<dim>::for_each_boundary_value(const BoundaryConditions<dim>              &boundary_conditions,
                                                    const Tensor<1, dim>                       &hydrostatic_gradient,
                                                    const double                                datum,
                                                    const std::map<types::boundary_id, double> &deficits,
                                                    const GivenVelocities                      &velocities,
                                                    const Action                               &action) const
  {
    const types::global_dof_index first_pressure = dofs->first_pressure();
    for (const PrescribedDof<dim> &b : boundary_dofs)
      {
        if (b.component == dim)
          {
            if (dofs->partitioner(1).in_local_range(b.dof - first_pressure))
              {
                const auto deficit = deficits.find(b.boundary);
                action(1,
                       b.dof - first_pressure,
                       boundary_conditions.value(boundary_conditions.all().at(b.boundary), b.point) -
                         hydrostatic_gradient * b.point - datum - (deficit == deficits.end() ? 0. : deficit->second));
              }
          }
        else if (dofs->partitioner(0).in_local_range(b.dof))
          action(0, b.dof, velocities.at(b.dof / dim)[b.component]); // velocities are numbered as their nodes
      }
  }


  template <int dim>
  void BoundaryValues<dim>::apply_boundary_values(const BoundaryConditions<dim>              &boundary_conditions,
                                                  const Tensor<1, dim>                       &hydrostatic_gradient,
                                                  const double                                datum,
                                                  const std::map<types::boundary_id, double> &deficits,
                                                  const GivenVelocities                      &velocities,
                                                  BlockVector                                &field) const
  {
    field.zero_out_ghost_values();
    for_each_boundary_value(boundary_conditions,
                            hydrostatic_gradient,
                            datum,
                            deficits,
                            velocities,
                            [&](const unsigned int block, const types::global_dof_index dof, const double value) {
                              field.block(block)(dof) = value;
                            });
    dofs->hanging_constraints().distribute(field);
    field.update_ghost_values();
  }


  template <int dim>
  bool BoundaryValues<dim>::has_boundary_values(const BoundaryConditions<dim>              &boundary_conditions,
                                                const Tensor<1, dim>                       &hydrostatic_gradient,
                                                const double                                datum,
                                                const std::map<types::boundary_id, double> &deficits,
                                                const GivenVelocities                      &velocities,
                                                const BlockVector                          &field) const
  {
    int same = 1;
    for_each_boundary_value(boundary_conditions,
                            hydrostatic_gradient,
                            datum,
                            deficits,
                            velocities,
                            [&](const unsigned int block, const types::global_dof_index dof, const double value) {
                              if (field.block(block)(dof) != value)
                                same = 0;
                            });
    return Utilities::MPI::min(same, dofs->communicator()) == 1;
  }


  template <int dim>
  double BoundaryValues<dim>::pressure_datum(const BoundaryConditions<dim> &boundary_conditions,
                                             const Tensor<1, dim>          &hydrostatic_gradient) const
  {
    // the node with the lowest number that has a pressure, whichever rank knows it
    const auto              nowhere = std::numeric_limits<types::global_dof_index>::max();
    types::global_dof_index first   = nowhere;
    double                  value   = 0.;
    for (const PrescribedDof<dim> &b : boundary_dofs)
      if (b.component == dim && b.dof < first)
        {
          first = b.dof;
          value = boundary_conditions.value(boundary_conditions.all().at(b.boundary), b.point) -
                  hydrostatic_gradient * b.point;
        }
    const auto lowest = Utilities::MPI::min(first, dofs->communicator());
    if (lowest == nowhere)
      return 0.;
    return Utilities::MPI::max(first == lowest ? value : -std::numeric_limits<double>::max(), dofs->communicator());
  }


  template class BoundaryValues<2>;
} // namespace alluvium::fluid
