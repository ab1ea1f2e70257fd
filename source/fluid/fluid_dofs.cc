#include <alluvium/fluid/fluid_dofs.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/tria.h>

namespace alluvium::fluid
{
  using namespace dealii;

  template <int dim>
  bool FluidDofs<dim>::has_triangles() const
  {
    return tria->all_reference_cells_are_simplex();
  }


  template <int dim>
  void FluidDofs<dim>::attach(const Triangulation<dim> &triangulation)
  {
    tria = &triangulation;
    dofs.reinit(triangulation);
    nodal_dofs.reinit(triangulation);
    if (has_triangles())
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
  void FluidDofs<dim>::reinit()
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
    nodal =
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
  }


  template <int dim>
  void FluidDofs<dim>::number_by_nodes()
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
  void FluidDofs<dim>::make_periodic(const DoFHandler<dim> &handler, AffineConstraints<double> &constraints) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (box.length[d] > 0.)
        DoFTools::make_periodicity_constraints(handler, 2 * d, 2 * d + 1, d, constraints);
  }


  template <int dim>
  BlockVector FluidDofs<dim>::make_field() const
  {
    BlockVector field;
    reinit_field(field);
    return field;
  }


  template <int dim>
  Vector FluidDofs<dim>::make_nodal_field() const
  {
    return Vector(nodal);
  }


  template <int dim>
  void FluidDofs<dim>::reinit_field(BlockVector &field) const
  {
    field.reinit(2);
    for (unsigned int b = 0; b < 2; ++b)
      field.block(b).reinit(partitioners[b]);
    field.collect_sizes();
  }


  template <int dim>
  void FluidDofs<dim>::reinit_nodal_field(Vector &field) const
  {
    field.reinit(nodal);
  }


  template <int dim>
  void FluidDofs<dim>::interpolate_hanging_nodes(Vector &nodal_field) const
  {
    nodal_field.zero_out_ghost_values();
    nodal_hanging.distribute(nodal_field);
    nodal_field.update_ghost_values();
  }


  template class FluidDofs<2>;
} // namespace alluvium::fluid
