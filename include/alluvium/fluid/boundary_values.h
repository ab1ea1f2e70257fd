#pragma once

#include <alluvium/fluid/boundary_nodes.h>
#include <alluvium/fluid/fluid_dofs.h>
#include <alluvium/geometry/boundary_part.h>

namespace alluvium::fluid
{
  /** What boundary conditions hold of the unknowns, and the faces through which fluid goes. */
  template <int dim>
  class BoundaryValues
  {
  public:
    /** Let parts of sides be boundaries of their own from the next reinit() on. */
    void set_parts(const std::vector<geometry::BoundaryPart> &boundary_parts) { parts = boundary_parts; }

    /** What boundaries the face from @p a to @p b of the side @p id consists of. */
    std::vector<geometry::FacePart>
    divide_face(const dealii::types::boundary_id id, const dealii::Point<dim> &a, const dealii::Point<dim> &b) const;

    /**
     * For new numbers of the unknowns, or other kinds of boundary conditions. @p fluid_dofs must outlive this. Throws
     * UserError for a boundary that no node sees. Collective.
     */
    void reinit(const FluidDofs<dim> &fluid_dofs, const BoundaryConditions<dim> &boundary_conditions);

    /** Hanging nodes and boundary conditions, all homogeneous (for increments). */
    const dealii::AffineConstraints<double> &constraints() const { return all_constraints; }

    /** Velocities of the fluid by nodal dof [m/s]. */
    using GivenVelocities = std::map<dealii::types::global_dof_index, dealii::Tensor<1, dim>>;

    /**
     * Set @p field's boundary values at the time of @p boundary_conditions, then its hanging nodes. The reduced
     * pressure is p - rho g.x - @p datum, with @p hydrostatic_gradient = rho g, less what @p deficits say of its
     * boundary (none if that is not among them) [Pa]. @p velocities are those of the nodes at which they are given.
     */
    void apply_boundary_values(const BoundaryConditions<dim>                      &boundary_conditions,
                               const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                               const double                                        datum,
                               const std::map<dealii::types::boundary_id, double> &deficits,
                               const GivenVelocities                              &velocities,
                               BlockVector                                        &field) const;

    /** Has @p field these boundary values already, to the last bit? Collective. */
    bool has_boundary_values(const BoundaryConditions<dim>                      &boundary_conditions,
                             const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                             const double                                        datum,
                             const std::map<dealii::types::boundary_id, double> &deficits,
                             const GivenVelocities                              &velocities,
                             const BlockVector                                  &field) const;

    /**
     * The prescribed p - rho g.x at one node, the same on all ranks: a datum that spares the linear solver large
     * constants. Zero if no boundary has a pressure. Collective.
     */
    double pressure_datum(const BoundaryConditions<dim> &boundary_conditions,
                          const dealii::Tensor<1, dim>  &hydrostatic_gradient) const;

    /**
     * A test function that is 1 on the nodes of one boundary and 0 on all others, on the cells where it does not
     * vanish; at nodes where boundaries with a given pressure meet, it is what they share. The residual of the
     * continuity equation against it is the flux through that boundary, with what is given on others around.
     */
    struct BoundaryWeight
    {
      unsigned int                       cell;
      std::array<double, max_nodes<dim>> weight;
    };
    const std::vector<BoundaryWeight> &weights_at(const dealii::types::boundary_id id) const
    {
      return boundary_weights.at(id);
    }

    /** Of all cells that this rank knows. */
    const std::vector<InflowFace<dim>>                               &inflow_faces() const { return inflow; }
    const std::map<dealii::types::global_dof_index, InflowNode<dim>> &inflow_nodes() const { return inflow_at; }
    /** Of owned cells. */
    const std::vector<BoundaryFace<dim>> &faces() const { return boundary_faces; }
    /** Ids of the boundaries with a given pressure, in order, the same on all ranks. */
    const std::vector<dealii::types::boundary_id> &open_boundaries() const { return open_ids; }

  private:
    /** Call @p action(block, index in the block, value) for all locally owned boundary values. */
    template <typename Action>
    void for_each_boundary_value(const BoundaryConditions<dim>                      &boundary_conditions,
                                 const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                                 const double                                        datum,
                                 const std::map<dealii::types::boundary_id, double> &deficits,
                                 const GivenVelocities                              &velocities,
                                 const Action                                       &action) const;
    void find_weights(const BoundaryNodes<dim> &nodes, const BoundaryConditions<dim> &boundary_conditions);

    const FluidDofs<dim>               *dofs = nullptr;
    std::vector<geometry::BoundaryPart> parts;
    dealii::AffineConstraints<double>   all_constraints;

    std::vector<PrescribedDof<dim>>                                   boundary_dofs;
    std::map<dealii::types::boundary_id, std::vector<BoundaryWeight>> boundary_weights;
    std::vector<InflowFace<dim>>                                      inflow;
    std::map<dealii::types::global_dof_index, InflowNode<dim>>        inflow_at;
    std::vector<BoundaryFace<dim>>                                    boundary_faces;
    std::vector<dealii::types::boundary_id>                           open_ids;
  };
} // namespace alluvium::fluid
