#pragma once

#include <alluvium/fluid/boundary_values.h>
#include <alluvium/fluid/cell_cache.h>

namespace alluvium::fluid
{
  /**
   * Equal-order linear velocity-pressure space on a mesh of quadrilaterals (with hanging nodes) or triangles: its
   * unknowns, with what boundary conditions hold of them and the cached geometry of its cells. Rebuilt when the mesh
   * changes.
   */
  template <int dim>
  class FluidSpace : public FluidDofs<dim>
  {
  public:
    FluidSpace() = default;
    explicit FluidSpace(const dealii::Triangulation<dim> &triangulation) { this->attach(triangulation); }

    /** Call after the mesh or the kinds of boundary conditions changed; it is the two calls below. Collective. */
    void reinit(const BoundaryConditions<dim> &boundary_conditions)
    {
      number();
      build_on_numbers(boundary_conditions);
    }

    /** Number the unknowns anew, for the mesh as it is: enough to carry fields from mesh to mesh. Collective. */
    void number() { FluidDofs<dim>::reinit(); }

    /** Find boundary values and cells for these numbers. Collective. */
    void build_on_numbers(const BoundaryConditions<dim> &boundary_conditions);

    BoundaryValues<dim>       &boundary() { return boundary_values; }
    const BoundaryValues<dim> &boundary() const { return boundary_values; }

    /** Hanging nodes and boundary conditions, all homogeneous (for increments). */
    const dealii::AffineConstraints<double> &constraints() const { return boundary_values.constraints(); }

    const std::vector<CellData<dim>> &cells() const { return cache.cells(); }
    unsigned int                      n_q_points() const { return cache.n_q_points(); }
    /** Shape values [quadrature point][node], the same on every cell. */
    const std::array<std::array<double, max_nodes<dim>>, max_nodes<dim>> &shape_values() const
    {
      return cache.shape_values();
    }
    /** Integral of each nodal basis function [m^dim], hanging nodes condensed. */
    const Vector &node_volumes() const { return cache.node_volumes(); }

  private:
    BoundaryValues<dim> boundary_values;
    CellCache<dim>      cache;
  };
} // namespace alluvium::fluid
