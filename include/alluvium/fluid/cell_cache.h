#pragma once

#include <alluvium/fluid/fluid_dofs.h>
#include <alluvium/fluid/interphase.h>

namespace alluvium::fluid
{
  /**
   * What the assembly needs of one locally owned cell, computed once a mesh. Local indices address ghosted vectors
   * directly (Vector::local_element), which a loop over dof handlers and FEValues could not do as fast.
   */
  template <int dim>
  struct CellData
  {
    static constexpr unsigned int n = max_nodes<dim>;

    double                                                measure, size; // [m^dim], [m]
    std::array<std::array<std::array<double, dim>, n>, n> grad;          // [quadrature point][node]
    std::array<double, n>                                 jxw;
    std::array<std::array<unsigned int, dim>, n>          velocity; // local indices in block 0
    std::array<unsigned int, n>                           pressure; // in block 1
    std::array<unsigned int, n>                           node;     // in scalar nodal fields
    std::array<dealii::Point<dim>, n>                     vertex;
    std::array<dealii::types::global_dof_index, n *(dim + 1)>
         dofs;          // global; [node * (dim+1) + component], component dim: p
    bool constrained;   // does any dof carry a constraint?
    bool parallelogram; // or a triangle: the map from the reference cell is affine, its inverse's gradients are
    std::array<std::array<double, dim>, dim> to_reference; // [reference coordinate][direction] [1/m]
  };

  /** The geometry of this rank's cells, and what follows from it alone; found once a mesh. */
  template <int dim>
  class CellCache
  {
  public:
    /** @p constraints: those of all unknowns, boundary conditions included. Collective. */
    void reinit(const FluidDofs<dim> &dofs, const dealii::AffineConstraints<double> &constraints);

    const std::vector<CellData<dim>> &cells() const { return cell_data; }
    unsigned int                      n_q_points() const { return n_q; }
    /** Shape values [quadrature point][node], the same on every cell. */
    const std::array<std::array<double, max_nodes<dim>>, max_nodes<dim>> &shape_values() const { return shapes; }
    /** Integral of each nodal basis function [m^dim], hanging nodes condensed. */
    const Vector &node_volumes() const { return volumes; }

  private:
    unsigned int                                                   n_q = 0;
    std::array<std::array<double, max_nodes<dim>>, max_nodes<dim>> shapes;
    std::vector<CellData<dim>>                                     cell_data;
    Vector                                                         volumes;
  };
} // namespace alluvium::fluid
