#pragma once

#include <alluvium/mesh/field_transfer.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/numerics/vector_tools.h>

namespace mesh_test
{
  using namespace dealii;
  using alluvium::mesh::BlockVector;

  /** A velocity-pressure space like the fluid's, rebuilt as often as asked. */
  struct Space
  {
    explicit Space(const Triangulation<2> &mesh)
      : scalar(mesh.all_reference_cells_are_simplex() ? static_cast<const FiniteElement<2> &>(FE_SimplexP<2>(1)).clone()
                                                      : static_cast<const FiniteElement<2> &>(FE_Q<2>(1)).clone())
      , element(*scalar, 3)
      , communicator(mesh.get_communicator())
      , dofs(mesh)
      , nodal_dofs(mesh)
    {
      rebuild();
    }

    void rebuild()
    {
      dofs.distribute_dofs(element);
      DoFRenumbering::Cuthill_McKee(dofs);
      const std::vector<unsigned int> block{0, 0, 1};
      DoFRenumbering::component_wise(dofs, block);
      nodal_dofs.distribute_dofs(*scalar);
      const auto n = DoFTools::count_dofs_per_fe_block(dofs, block);
      IndexSet   relevant;
      DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      DoFTools::extract_locally_relevant_dofs(nodal_dofs, relevant_nodal);
      owned   = {dofs.locally_owned_dofs().get_view(0, n[0]), dofs.locally_owned_dofs().get_view(n[0], n[0] + n[1])};
      ghosted = {relevant.get_view(0, n[0]), relevant.get_view(n[0], n[0] + n[1])};
      hanging.clear();
      hanging.reinit(relevant);
      DoFTools::make_hanging_node_constraints(dofs, hanging);
      hanging.close();
      nodal_hanging.clear();
      nodal_hanging.reinit(relevant_nodal);
      DoFTools::make_hanging_node_constraints(nodal_dofs, nodal_hanging);
      nodal_hanging.close();
    }

    BlockVector            field() const { return BlockVector(owned, ghosted, communicator); }
    alluvium::mesh::Vector nodal_field() const
    {
      return alluvium::mesh::Vector(nodal_dofs.locally_owned_dofs(), relevant_nodal, communicator);
    }

    std::unique_ptr<FiniteElement<2>> scalar;
    FESystem<2>                       element;
    MPI_Comm                          communicator;
    DoFHandler<2>                     dofs, nodal_dofs;
    AffineConstraints<double>         hanging, nodal_hanging;
    std::vector<IndexSet>             owned, ghosted;
    IndexSet                          relevant_nodal;
  };

  class LinearField : public Function<2>
  {
  public:
    explicit LinearField(const unsigned int n_components)
      : Function<2>(n_components)
    {}
    double value(const Point<2> &p, const unsigned int component) const override
    {
      return 1. + component + (2. + component) * p[0] - 3. * p[1];
    }
  };
} // namespace mesh_test
