#include <alluvium/fluid/boundary_nodes.h>
#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/piece_gradients.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/tria.h>

#include <limits>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool is_simplex_mesh(const Triangulation<dim> &tria)
    {
      return tria.all_reference_cells_are_simplex();
    }

    template <int dim>
    Quadrature<dim> cell_quadrature(const bool simplex)
    {
      if (simplex)
        return QGaussSimplex<dim>(2);
      return QGauss<dim>(2);
    }
  } // namespace


  template <int dim>
  void FluidSpace<dim>::attach(const Triangulation<dim> &triangulation)
  {
    tria = &triangulation;
    dofs.reinit(triangulation);
    nodal_dofs.reinit(triangulation);
    if (is_simplex_mesh(triangulation))
      {
        scalar_fe = std::make_unique<FE_SimplexP<dim>>(1);
        map       = std::make_unique<MappingFE<dim>>(FE_SimplexP<dim>(1));
      }
    else
      {
        check_user(triangulation.all_reference_cells_are_hyper_cube(),
                   "The fluid mesh mixes cell types: give only quadrilaterals or only triangles.");
        scalar_fe = std::make_unique<FE_Q<dim>>(1);
        map       = std::make_unique<MappingQ1<dim>>();
      }
    system_fe = std::make_unique<FESystem<dim>>(*scalar_fe, dim + 1);
    n_nodes   = scalar_fe->n_dofs_per_cell();
  }


  template <int dim>
  void FluidSpace<dim>::reinit(const BoundaryConditions<dim> &boundary_conditions)
  {
    dofs.distribute_dofs(*system_fe);
    nodal_dofs.distribute_dofs(*scalar_fe);
    number_by_nodes();

    const auto n_p = nodal_dofs.n_dofs(), n_u = dim * n_p;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant_all);
    owned_blocks    = {dofs.locally_owned_dofs().get_view(0, n_u), dofs.locally_owned_dofs().get_view(n_u, n_u + n_p)};
    relevant_blocks = {relevant_all.get_view(0, n_u), relevant_all.get_view(n_u, n_u + n_p)};

    partitioners.clear();
    for (unsigned int b = 0; b < 2; ++b)
      partitioners.push_back(
        std::make_shared<Utilities::MPI::Partitioner>(owned_blocks[b], relevant_blocks[b], communicator()));
    IndexSet relevant_nodal;
    DoFTools::extract_locally_relevant_dofs(nodal_dofs, relevant_nodal);
    nodal_partitioner =
      std::make_shared<Utilities::MPI::Partitioner>(nodal_dofs.locally_owned_dofs(), relevant_nodal, communicator());

    hanging.clear();
    hanging.reinit(relevant_all);
    DoFTools::make_hanging_node_constraints(dofs, hanging);
    make_periodic(dofs, hanging);
    hanging.close();
    nodal_hanging.clear();
    nodal_hanging.reinit(relevant_nodal);
    DoFTools::make_hanging_node_constraints(nodal_dofs, nodal_hanging);
    make_periodic(nodal_dofs, nodal_hanging);
    nodal_hanging.close();

    make_constraints(boundary_conditions);
    cache_cells();
  }


  template <int dim>
  std::vector<geometry::FacePart>
  FluidSpace<dim>::divide_face(const types::boundary_id id, const Point<dim> &a, const Point<dim> &b) const
  {
    return geometry::divide_face(parts, id, {{a[0], a[1]}}, {{b[0], b[1]}});
  }


  template <int dim>
  void FluidSpace<dim>::number_by_nodes()
  {
    // Cuthill and McKee's order starts from the one that it finds, which must not depend on the mesh's history
    if (dynamic_cast<const parallel::distributed::Triangulation<dim> *>(tria))
      DoFRenumbering::hierarchical(nodal_dofs);
    // the bandwidth of the nodes is that of the unknowns, and found in a fraction of the time
    DoFRenumbering::Cuthill_McKee(nodal_dofs);
    const IndexSet &owned = dofs.locally_owned_dofs(), &owned_nodes = nodal_dofs.locally_owned_dofs();
    std::vector<types::global_dof_index> number(owned.n_elements());
    std::vector<types::global_dof_index> cell_dofs(system_fe->n_dofs_per_cell()), cell_nodes(n_nodes);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(cell_dofs);
          nodal_cell(cell)->get_dof_indices(cell_nodes);
          for (unsigned int v = 0; v < n_nodes; ++v)
            if (owned_nodes.is_element(cell_nodes[v]))
              for (unsigned int c = 0; c <= dim; ++c)
                number[owned.index_within_set(cell_dofs[system_fe->component_to_system_index(c, v)])] =
                  c < dim ? dim * cell_nodes[v] + c : dim * nodal_dofs.n_dofs() + cell_nodes[v];
        }
    dofs.renumber_dofs(number);
  }


  template <int dim>
  void FluidSpace<dim>::make_periodic(const DoFHandler<dim> &handler, AffineConstraints<double> &constraints) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (box.length[d] > 0.)
        DoFTools::make_periodicity_constraints(handler, 2 * d, 2 * d + 1, d, constraints);
  }


  template <int dim>
  void FluidSpace<dim>::make_constraints(const BoundaryConditions<dim> &boundary_conditions)
  {
    const BoundaryNodes<dim> boundary(*this, boundary_conditions);
    inflow    = boundary.inflow;
    inflow_at = boundary.inflow_nodes();
    open      = boundary.open;
    open_ids.clear();
    for (const auto &[id, condition] : boundary_conditions.all())
      if (condition.kind == BoundaryConditions<dim>::Kind::pressure)
        open_ids.push_back(id);
    system_constraints.clear();
    system_constraints.reinit(relevant_all);
    system_constraints.merge(hanging);
    boundary_dofs = boundary.constrain(hanging, system_constraints);
    if (boundary_conditions.pins_pressure())
      {
        const types::global_dof_index first_pressure = partitioners[0]->size();
        if (relevant_all.is_element(first_pressure) && !system_constraints.is_constrained(first_pressure))
          system_constraints.add_line(first_pressure);
      }
    system_constraints.close();

    boundary_weights.clear();
    std::vector<types::global_dof_index> cell_nodes(n_nodes);
    for (const auto &[id, condition] : boundary_conditions.all())
      {
        Vector weight = make_nodal_field();
        for (const auto index : boundary.nodes_of(id))
          if (nodal_partitioner->in_local_range(index))
            weight(index) = boundary.share(index, id);
        check_user(condition.kind != BoundaryConditions<dim>::Kind::pressure || weight.linfty_norm() > 0.,
                   "Boundary conditions/Pressure: no node of the fluid's mesh lies on '" + condition.name +
                     "': it is narrower than a cell there. Make the cells smaller, or give a velocity, whose flux is "
                     "exact on cells of any size.");
        interpolate_hanging_nodes(weight);
        auto        &list       = boundary_weights[id];
        unsigned int cell_index = 0;
        for (const auto &cell : ordered_cells(nodal_dofs))
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
  void FluidSpace<dim>::cache_cells()
  {
    const bool            simplex    = is_simplex_mesh(*tria);
    const Quadrature<dim> quadrature = cell_quadrature<dim>(simplex);
    n_q                              = quadrature.size();
    AssertThrow(n_q <= max_nodes<dim>, ExcInternalError());
    FEValues<dim> values(*map, *scalar_fe, quadrature, update_values | update_gradients | update_JxW_values);

    const types::global_dof_index        first_pressure = partitioners[0]->size();
    std::vector<types::global_dof_index> cell_dofs(system_fe->n_dofs_per_cell()), cell_nodes(n_nodes);
    cell_data.clear();
    reinit_nodal_field(volumes);
    for (const auto &cell : ordered_cells(dofs))
      if (cell->is_locally_owned())
        {
          const auto nodal = nodal_cell(cell);
          values.reinit(nodal);
          cell->get_dof_indices(cell_dofs);
          nodal->get_dof_indices(cell_nodes);
          CellData<dim> data{};
          data.size = cell->diameter() / std::sqrt(double(dim));
          for (unsigned int q = 0; q < n_q; ++q)
            {
              data.jxw[q] = values.JxW(q);
              data.measure += data.jxw[q];
              for (unsigned int v = 0; v < n_nodes; ++v)
                {
                  shapes[q][v] = values.shape_value(v, q);
                  for (unsigned int d = 0; d < dim; ++d)
                    data.grad[q][v][d] = values.shape_grad(v, q)[d];
                }
            }
          for (unsigned int v = 0; v < n_nodes; ++v)
            {
              data.vertex[v] = cell->vertex(v);
              data.node[v]   = nodal_partitioner->global_to_local(cell_nodes[v]);
              for (unsigned int c = 0; c <= dim; ++c)
                {
                  const auto dof               = cell_dofs[system_fe->component_to_system_index(c, v)];
                  data.dofs[v * (dim + 1) + c] = dof;
                  data.constrained             = data.constrained || system_constraints.is_constrained(dof);
                  if (c < dim)
                    data.velocity[v][c] = partitioners[0]->global_to_local(dof);
                  else
                    data.pressure[v] = partitioners[1]->global_to_local(dof - first_pressure);
                }
            }
          if (!simplex)
            {
              // opposite edges alike: the map is affine and the pieces' moments integrate Q1 exactly
              data.parallelogram = true;
              if constexpr (dim == 2)
                data.parallelogram =
                  (data.vertex[0] + (data.vertex[3] - data.vertex[1]) - data.vertex[2]).norm() < 1e-12 * data.size;
            }
          else
            data.parallelogram = true;
          if constexpr (dim == 2)
            data.to_reference = inverse_jacobian(data.vertex[1] - data.vertex[0], data.vertex[2] - data.vertex[0]);
          cell_data.push_back(data);

          dealii::Vector<double> local(n_nodes);
          for (unsigned int v = 0; v < n_nodes; ++v)
            for (unsigned int q = 0; q < n_q; ++q)
              local(v) += shapes[q][v] * data.jxw[q];
          nodal_hanging.distribute_local_to_global(local, cell_nodes, volumes);
        }
    volumes.compress(VectorOperation::add);
    volumes.update_ghost_values();
  }


  template <int dim>
  BlockVector FluidSpace<dim>::make_field() const
  {
    BlockVector field;
    reinit_field(field);
    return field;
  }


  template <int dim>
  Vector FluidSpace<dim>::make_nodal_field() const
  {
    return Vector(nodal_partitioner);
  }


  template <int dim>
  void FluidSpace<dim>::reinit_field(BlockVector &field) const
  {
    field.reinit(2);
    for (unsigned int b = 0; b < 2; ++b)
      field.block(b).reinit(partitioners[b]);
    field.collect_sizes();
  }


  template <int dim>
  void FluidSpace<dim>::reinit_nodal_field(Vector &field) const
  {
    field.reinit(nodal_partitioner);
  }


  template <int dim>
  template <typename Action>
  void FluidSpace<dim>::for_each_boundary_value(const BoundaryConditions<dim>              &boundary_conditions,
                                                const Tensor<1, dim>                       &hydrostatic_gradient,
                                                const double                                datum,
                                                const std::map<types::boundary_id, double> &deficits,
                                                const GivenVelocities                      &velocities,
                                                const Action                               &action) const
  {
    const types::global_dof_index first_pressure = partitioners[0]->size();
    for (const PrescribedDof<dim> &b : boundary_dofs)
      {
        if (b.component == dim)
          {
            if (partitioners[1]->in_local_range(b.dof - first_pressure))
              {
                const auto deficit = deficits.find(b.boundary);
                action(1,
                       b.dof - first_pressure,
                       boundary_conditions.value(boundary_conditions.all().at(b.boundary), b.point) -
                         hydrostatic_gradient * b.point - datum - (deficit == deficits.end() ? 0. : deficit->second));
              }
          }
        else if (partitioners[0]->in_local_range(b.dof))
          action(0, b.dof, velocities.at(b.dof / dim)[b.component]); // velocities are numbered as their nodes
      }
  }


  template <int dim>
  void FluidSpace<dim>::apply_boundary_values(const BoundaryConditions<dim>              &boundary_conditions,
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
    hanging.distribute(field);
    field.update_ghost_values();
  }


  template <int dim>
  bool FluidSpace<dim>::has_boundary_values(const BoundaryConditions<dim>              &boundary_conditions,
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
    return Utilities::MPI::min(same, communicator()) == 1;
  }


  template <int dim>
  double FluidSpace<dim>::pressure_datum(const BoundaryConditions<dim> &boundary_conditions,
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
    const auto lowest = Utilities::MPI::min(first, communicator());
    if (lowest == nowhere)
      return 0.;
    return Utilities::MPI::max(first == lowest ? value : -std::numeric_limits<double>::max(), communicator());
  }


  template <int dim>
  void FluidSpace<dim>::interpolate_hanging_nodes(Vector &nodal_field) const
  {
    nodal_field.zero_out_ghost_values();
    nodal_hanging.distribute(nodal_field);
    nodal_field.update_ghost_values();
  }


  template class FluidSpace<2>;
} // namespace alluvium::fluid
