#pragma once

#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/interphase.h>

#include <deal.II/lac/affine_constraints.h>

#include <map>
#include <set>
#include <vector>

namespace alluvium::fluid
{
  template <int dim>
  class FluidSpace;

  /** A dof whose value a boundary condition gives: a component of the boundary's function at a point. */
  template <int dim>
  struct PrescribedDof
  {
    dealii::types::global_dof_index dof;
    dealii::types::boundary_id      boundary;
    unsigned int                    component; // dim: pressure
    dealii::Point<dim>              point;
  };

  /** A face with prescribed velocity, through which the continuity equation needs the flux. */
  template <int dim>
  struct InflowFace
  {
    unsigned int                                    cell;
    std::vector<std::array<double, max_nodes<dim>>> phi; // [quadrature point][node of the cell]
    std::vector<dealii::Tensor<1, dim>>             normal_jxw;
  };

  /** A face through which the fluid may go in and out: the pressure is given there. */
  template <int dim>
  struct OpenFace
  {
    unsigned int               cell;
    dealii::types::boundary_id boundary;
    double                     depth; // of the fluid around the face's nodes, normal to it [m]

    std::vector<std::array<double, max_nodes<dim>>>                  phi;  // [quadrature point][node of the cell]
    std::vector<std::array<std::array<double, dim>, max_nodes<dim>>> grad; // [1/m]
    std::vector<dealii::Tensor<1, dim>>                              normal;
    std::vector<double>                                              jxw;
  };

  /**
   * The nodes of the mesh that lie on boundaries, which conditions meet at each of them, and what these ask of its
   * dofs: where a wall meets an inflow, the wall wins; slip walls that meet at a corner hold both components.
   */
  template <int dim>
  class BoundaryNodes
  {
  public:
    /** Of the cells that this rank knows; @p space must have its dofs and hanging nodes. */
    BoundaryNodes(const FluidSpace<dim> &space, const BoundaryConditions<dim> &boundary_conditions);

    /**
     * Add homogeneous constraints to @p constraints, where @p hanging has none.
     * @return the dofs among them whose values boundary conditions give
     */
    std::vector<PrescribedDof<dim>> constrain(const dealii::AffineConstraints<double> &hanging,
                                              dealii::AffineConstraints<double>       &constraints) const;

    /** Nodal dofs on boundary @p id. */
    const std::set<dealii::types::global_dof_index> &nodes_of(const dealii::types::boundary_id id) const
    {
      return on_boundary.at(id);
    }

    std::vector<InflowFace<dim>> inflow; // of owned cells
    std::vector<OpenFace<dim>>   open;   // of owned cells

  private:
    using Kind = typename BoundaryConditions<dim>::Kind;

    struct Node
    {
      std::array<dealii::types::global_dof_index, dim + 1> dof;
      dealii::Point<dim>                                   point;
      std::map<Kind, dealii::types::boundary_id>           kinds;
      std::vector<dealii::Tensor<1, dim>>                  slip_normals; // of the slip walls that meet here
    };

    std::map<dealii::types::global_dof_index, Node>                                 nodes; // by nodal dof
    std::map<dealii::types::boundary_id, std::set<dealii::types::global_dof_index>> on_boundary;
  };
} // namespace alluvium::fluid
