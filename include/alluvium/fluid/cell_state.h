#pragma once

#include <alluvium/fluid/vans_problem.h>

namespace alluvium::fluid
{
  /** The equations of one cell with n nodes, ordered node * (dim+1) + component, component dim the pressure. */
  template <int dim, int n>
  using LocalVector = std::array<double, n *(dim + 1)>;
  template <int dim, int n>
  using LocalMatrix = std::array<LocalVector<dim, n>, n *(dim + 1)>;

  /**
   * What the terms of the weak form need of the cell they are integrated over: its pieces, nodal values and
   * stabilisation. The number of nodes is a template argument so that the compiler unrolls the loops.
   */
  template <int dim, int n>
  struct CellState
  {
    static constexpr unsigned int n_local = n * (dim + 1);
    using Matrix                          = LocalMatrix<dim, n>;
    using Values                          = LocalVector<dim, n>;

    CellState(const FluidSpace<dim> &space, const VansProblem<dim> &problem)
      : space(space)
      , problem(problem)
    {}

    /** Look at a cell's void fraction only: enough for term_squares(). */
    void reinit_void_fraction(const unsigned int index);

    /** Read the cell's nodal values and find tau. */
    void reinit(const unsigned int index);

    bool has_pieces() const { return end > begin; }

    /** The cell's values of @p x in the local order. */
    LocalVector<dim, n> values(const BlockVector &x) const;

    /** The value of a nodal field where the shape functions are @p phi. */
    template <typename Values>
    double value(const std::array<double, n> &nodal, const Values &phi) const
    {
      double sum = 0.;
      for (unsigned int v = 0; v < n; ++v)
        sum += nodal[v] * phi[v];
      return sum;
    }

    /** u^n.grad of each shape function, zero without convection. */
    template <typename Gradients, typename Values>
    std::array<double, n> advect(const Gradients &grad, const Values &phi) const
    {
      std::array<double, n> result{};
      if (!problem.discretisation.convection)
        return result;
      std::array<double, dim> u{};
      for (unsigned int v = 0; v < n; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          u[d] += phi[v] * u_old[v][d];
      for (unsigned int v = 0; v < n; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          result[v] += u[d] * grad[v][d];
      return result;
    }

    const FluidSpace<dim>  &space;
    const VansProblem<dim> &problem;

    unsigned int                           begin = 0, end = 0; // its pieces
    const CellData<dim>                   *cell = nullptr;
    std::array<double, n>                  eps;
    std::array<std::array<double, dim>, n> u_old, u_start;       // u^n, and u of du/dt = (u^{n+1} - u)/dt
    std::array<double, dim>                u_mean;               // of u^n
    double                                 pspg = 0., supg = 0.; // tau eps, tau eps rho
  };
} // namespace alluvium::fluid
