#include <alluvium/fluid/cell_spin_terms.h>
#include <alluvium/fluid/piece_gradients.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** The second moments of a piece times the gradient of each shape function. */
    template <int n>
    inline std::array<std::array<double, 2>, n> spin_arms(const std::array<std::array<double, 2>, n> &grad,
                                                          const PieceSpin                            &spin)
    {
      std::array<std::array<double, 2>, n> arms;
      for (unsigned int v = 0; v < n; ++v)
        arms[v] = {{spin.moments[0] * grad[v][0] + spin.moments[1] * grad[v][1],
                    spin.moments[1] * grad[v][0] + spin.moments[2] * grad[v][1]}};
      return arms;
    }

    /**
     * phi_i ez x (x_i - c) over the root of sum phi_i |x_i - c|^2: nodal velocities are projected on a rotation about
     * the piece's centroid c by its inner product with them.
     */
    template <int dim, int n>
    std::array<std::array<double, dim>, n> rotation_of_nodes(const CellState<dim, n> &state, const PieceShape<dim> &s)
    {
      Point<dim> centroid;
      for (unsigned int v = 0; v < n; ++v)
        centroid += s.phi[v] * state.cell->vertex[v];
      std::array<std::array<double, dim>, n> turn;
      double                                 square = 0.;
      for (unsigned int v = 0; v < n; ++v)
        {
          const Tensor<1, dim> arm = state.cell->vertex[v] - centroid;
          square += s.phi[v] * arm.norm_square();
          turn[v] = {{-s.phi[v] * arm[1], s.phi[v] * arm[0]}};
        }
      const double factor = square > 1e-20 * state.cell->measure ? 1. / std::sqrt(square) : 0.;
      for (auto &t : turn)
        for (double &component : t)
          component *= factor;
      return turn;
    }
  } // namespace


  template <int dim, int n>
  void add_spin(const CellState<dim, n> &state, const unsigned int k, const double drag, LocalMatrix<dim, n> &L)
  {
    const PieceShape<dim> &s     = state.problem.solid->shape[k];
    const PieceSpin       &spin  = state.problem.solid->spin[k];
    const auto             grad  = piece_gradients<n>(*state.cell, s.phi);
    const auto             arms  = spin_arms<n>(grad, spin);
    const auto            &x     = state.problem.solid->exchange[k];
    const double           gamma = s.area * spin.gamma * (1. - x.gamma * x.compliance);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int c = 0; c < dim; ++c)
          L[i * (dim + 1) + c][j * (dim + 1) + c] += gamma * (arms[i][0] * grad[j][0] + arms[i][1] * grad[j][1]);
    if (!state.problem.discretisation.lumped_drag)
      return;
    const auto turn = rotation_of_nodes(state, s);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int j = 0; j < n; ++j)
          for (unsigned int d = 0; d < dim; ++d)
            L[i * (dim + 1) + c][j * (dim + 1) + d] -= drag * turn[i][c] * turn[j][d];
  }


  template <int dim, int n>
  void known_spin(const CellState<dim, n> &state, const unsigned int k, LocalVector<dim, n> &r)
  {
    const PieceShape<dim>    &s     = state.problem.solid->shape[k];
    const PieceExchange<dim> &x     = state.problem.solid->exchange[k];
    const PieceSpin          &spin  = state.problem.solid->spin[k];
    const auto                grad  = piece_gradients<n>(*state.cell, s.phi);
    const auto                arms  = spin_arms<n>(grad, spin);
    const double              gamma = s.area * spin.gamma, b = x.gamma * x.compliance;
    const Vector             *reference = b == 0. ? nullptr : state.problem.reference[x.reference];
    // the known part of the solid's velocity gradient
    std::array<std::array<double, 2>, 2> known = {{{{0., -x.omega}}, {{x.omega, 0.}}}};
    if (reference)
      for (unsigned int v = 0; v < n; ++v)
        for (unsigned int c = 0; c < 2; ++c)
          for (unsigned int d = 0; d < 2; ++d)
            known[c][d] -= b * reference->local_element(state.cell->velocity[v][c]) * grad[v][d];
    for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int c = 0; c < 2; ++c)
          r[i * (dim + 1) + c] += gamma * (arms[i][0] * known[c][0] + arms[i][1] * known[c][1]);
        // a disc that turns displaces nothing: exactly, if the centroids' velocities are left out
        r[i * (dim + 1) + dim] -= s.area * x.omega * (grad[i][1] * spin.arm[0] - grad[i][0] * spin.arm[1]);
      }
    if (!state.problem.discretisation.lumped_drag || !reference)
      return;
    const auto turn  = rotation_of_nodes(state, s);
    double     omega = 0.;
    for (unsigned int v = 0; v < n; ++v)
      for (unsigned int d = 0; d < dim; ++d)
        omega += turn[v][d] * reference->local_element(state.cell->velocity[v][d]);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        r[i * (dim + 1) + d] += s.area * x.gamma * b * turn[i][d] * omega;
  }


  template void add_spin(const CellState<2, 3> &, const unsigned int, const double, LocalMatrix<2, 3> &);
  template void known_spin(const CellState<2, 3> &, const unsigned int, LocalVector<2, 3> &);
  template void add_spin(const CellState<2, 4> &, const unsigned int, const double, LocalMatrix<2, 4> &);
  template void known_spin(const CellState<2, 4> &, const unsigned int, LocalVector<2, 4> &);
} // namespace alluvium::fluid
