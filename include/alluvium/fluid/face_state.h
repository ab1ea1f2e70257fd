#pragma once

#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/cell_state.h>

#include <functional>

namespace alluvium::fluid
{
  /** Terms of a face in the equations of its cell's nodes, ordered node * (dim+1) + component, component dim the
   * pressure: matrix times unknowns = known. */
  template <int dim>
  struct FaceTerms
  {
    LocalMatrix<dim, max_nodes<dim>> matrix{};
    LocalVector<dim, max_nodes<dim>> known{};

    static constexpr unsigned int row(const unsigned int node, const unsigned int component)
    {
      return node * (dim + 1) + component;
    }
  };

  /**
   * The mean over a cell of what streamline upwinding weights, du/dt + grad p less body forces, as rows of a matrix and
   * known terms: upwind weights sum to zero, so that it is the sum of the cell's rows, less advection.
   */
  template <int dim>
  struct MeanResidual
  {
    std::array<LocalVector<dim, max_nodes<dim>>, dim> row{};
    std::array<double, dim>                           known{};
  };

  /**
   * What a kind of boundary condition sees of a face and its flow at t^n: shape functions and normals are in `face`, by
   * quadrature point and node of the cell.
   */
  template <int dim>
  class FaceState
  {
  public:
    /** @p backflow is the share of what enters through the boundary that is backflow, see backflow_shares(). */
    template <int n>
    FaceState(const CellState<dim, n> &cell, const BoundaryFace<dim> &face, const double backflow);

    unsigned int n_nodes() const { return nodes; }
    unsigned int n_q_points() const { return face.phi.size(); }

    double void_fraction(const unsigned int q) const;
    double old_normal_velocity(const unsigned int q) const; // u^n.n, n outwards [m/s]

    /** The value @p component of the boundary's condition, at the end of the step. Throws UserError, see there. */
    double value(const unsigned int q, const unsigned int component = 0) const
    {
      return problem.boundary_conditions->value(*condition, face.point[q], component);
    }

    /** What the unknown pressure leaves out: p = unknown + this [Pa]. */
    double pressure_left_out(const unsigned int q) const;

    MeanResidual<dim> mean_residual() const { return find_mean_residual(); }

    const BoundaryFace<dim> &face;
    const VansProblem<dim>  &problem;    // density, viscosity, dt
    double                   backflow;   // 0 to 1
    double                   supg;       // tau eps rho of the cell
    bool                     has_pieces; // are there pieces of grains in the cell?

  private:
    const typename BoundaryConditions<dim>::Condition  *condition;
    unsigned int                                        nodes;
    std::array<double, max_nodes<dim>>                  eps;
    std::array<std::array<double, dim>, max_nodes<dim>> u_old;
    std::function<MeanResidual<dim>()>                  find_mean_residual;
  };

  /** The terms of a face of the cell of @p state; see FaceState. */
  template <int dim, int n>
  FaceTerms<dim> face_terms(const CellState<dim, n> &state, const BoundaryFace<dim> &face, const double backflow);
} // namespace alluvium::fluid
