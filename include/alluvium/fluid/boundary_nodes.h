#pragma once

#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/fluid_dofs.h>
#include <alluvium/fluid/interphase.h>

#include <deal.II/lac/affine_constraints.h>

#include <map>
#include <optional>
#include <set>
#include <vector>

namespace alluvium::fluid
{
  template <int dim>
  class BoundaryValues;

  /** A dof whose value a boundary condition gives: a component of the boundary's function at a point. */
  template <int dim>
  struct PrescribedDof
  {
    dealii::types::global_dof_index dof;
    dealii::types::boundary_id      boundary;
    unsigned int                    component; // dim: pressure
    dealii::Point<dim>              point;
  };

  /** Part of a face on which the velocity is given, through which the continuity equation needs the flux. */
  template <int dim>
  struct InflowFace
  {
    bool                                           owned; // by this rank; other faces it only knows
    unsigned int                                   cell;  // if owned
    dealii::types::boundary_id                     boundary;
    std::array<unsigned int, 2>                    vertex; // of the cell, at the face's ends
    std::array<dealii::types::global_dof_index, 2> node;   // the same as nodal dofs
    std::array<dealii::Point<dim>, 2>              end;
    double                                         from, to; // the part: 0 the first end, 1 the second
    dealii::Tensor<1, dim>                         normal;   // outward, of length 1

    std::vector<std::array<double, max_nodes<dim>>> phi; // [quadrature point][node of the cell]
    std::vector<dealii::Tensor<1, dim>>             normal_jxw;

    double length() const { return end[0].distance(end[1]); } // of the whole face [m]
  };

  /** A node at which velocities are given. */
  template <int dim>
  struct InflowNode
  {
    dealii::types::boundary_id boundary;
    dealii::Point<dim>         point;
    bool                       whole;  // do faces of this boundary alone meet here, each a whole one?
    double                     length; // of the node's share of the boundary in line with these faces [m]
    dealii::Tensor<1, dim>     normal; // of these faces
  };

  /** A face, or part of one, whose condition gives the pressure or has terms. */
  template <int dim>
  struct BoundaryFace
  {
    unsigned int               cell;
    dealii::types::boundary_id boundary;
    double                     depth; // of the fluid around the face's nodes, normal to it [m]

    std::vector<std::array<double, max_nodes<dim>>>                  phi;  // [quadrature point][node of the cell]
    std::vector<std::array<std::array<double, dim>, max_nodes<dim>>> grad; // [1/m]
    std::vector<dealii::Tensor<1, dim>>                              normal;
    std::vector<double>                                              jxw;
    std::vector<dealii::Point<dim>>                                  point;
  };

  /**
   * The nodes of the mesh that lie on boundaries, which conditions meet at each of them, and what these ask of its
   * dofs: where a wall meets an inflow at a corner, the wall wins; slip walls that meet at a corner hold both
   * components. In line with a wall an inflow reaches as far as the shape functions of the nodes of its faces.
   */
  template <int dim>
  class BoundaryNodes
  {
  public:
    /** Of the cells that this rank knows; @p values divides their faces. */
    BoundaryNodes(const FluidDofs<dim>          &space,
                  const BoundaryValues<dim>     &values,
                  const BoundaryConditions<dim> &boundary_conditions);

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

    /** Where boundaries with a given pressure meet, the share of @p node that is boundary @p id's; else 1. */
    double share(const dealii::types::global_dof_index node, const dealii::types::boundary_id id) const;

    /** Where velocities are given, by nodal dof. */
    std::map<dealii::types::global_dof_index, InflowNode<dim>> inflow_nodes() const;

    std::vector<InflowFace<dim>>   inflow; // of all cells that this rank knows
    std::vector<BoundaryFace<dim>> faces;  // of owned cells

  private:
    using Velocity = typename BoundaryKind<dim>::Velocity;

    /** Half of a face that ends at a node, and how much of the face is a boundary's. */
    struct HalfFace
    {
      dealii::types::boundary_id boundary;
      const BoundaryKind<dim>   *kind;
      dealii::Tensor<1, dim>     normal;
      double                     length;         // [m]
      bool                       touches, whole; // does the part end at the node, is it all of the face?
    };

    struct Node
    {
      std::array<dealii::types::global_dof_index, dim + 1> dof;
      dealii::Point<dim>                                   point;
      std::map<Velocity, dealii::types::boundary_id>       velocities; // the first boundary that holds each
      std::optional<dealii::types::boundary_id>            pressure;   // the first that gives one
      std::vector<HalfFace>                                faces;

      std::vector<dealii::Tensor<1, dim>> normals_of(const Velocity velocity) const;

      /** A face whose velocity is given here, if one is. */
      const HalfFace *inflow() const;
    };

    std::map<dealii::types::global_dof_index, Node>                                 nodes; // by nodal dof
    std::map<dealii::types::boundary_id, std::set<dealii::types::global_dof_index>> on_boundary;
  };
} // namespace alluvium::fluid
