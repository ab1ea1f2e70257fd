#include <alluvium/fluid/cell_mesh_terms.h>

namespace alluvium::fluid
{
  using namespace dealii;


  template <int dim, int n>
  void add_mesh(const CellState<dim, n> &state, LocalMatrix<dim, n> &L)
  {
    const double rho = state.problem.fluid.density, eta = state.problem.fluid.viscosity, dt = state.problem.dt;
    const double pspg = state.pspg, supg = state.supg;
    for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
      {
        // copies: for all the compiler knows, L may be where the originals are
        const auto   phi  = state.space.shape_values()[q];
        const auto   grad = state.cell->grad[q];
        const double jxw  = state.cell->jxw[q];
        const double e = state.value(state.eps, phi), er = e * rho, e_eta = e * eta;
        // rate[j] = (d/dt + u^n.grad) of shape function j; test[i] = Galerkin + SUPG weight
        std::array<double, n> rate, test, streamline = state.advect(grad, phi);
        for (unsigned int v = 0; v < n; ++v)
          {
            rate[v] = er * (phi[v] / dt + streamline[v]);
            test[v] = phi[v] + supg * streamline[v];
          }
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            {
              double grad_grad = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                grad_grad += grad[i][d] * grad[j][d];
              const double diagonal = jxw * (test[i] * rate[j] + e_eta * grad_grad);
              for (unsigned int c = 0; c < dim; ++c)
                {
                  double *row = &L[i * (dim + 1) + c][j * (dim + 1)];
                  row[c] += diagonal;
                  for (unsigned int d = 0; d < dim; ++d)
                    row[d] += jxw * e_eta * grad[i][d] * grad[j][c];
                  row[dim] += jxw * test[i] * grad[j][c];
                  // continuity: - eps u.grad q, and PSPG with the momentum residual
                  L[i * (dim + 1) + dim][j * (dim + 1) + c] += jxw * grad[i][c] * (pspg * rate[j] - e * phi[j]);
                }
              L[i * (dim + 1) + dim][j * (dim + 1) + dim] += jxw * pspg * grad_grad;
            }
      }
  }


  template <int dim, int n>
  void add_mesh_right_hand_side(const CellState<dim, n> &state, LocalVector<dim, n> &b)
  {
    const double rho = state.problem.fluid.density, pspg = state.pspg, supg = state.supg;
    for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
      {
        const auto                  phi        = state.space.shape_values()[q];
        const auto                  grad       = state.cell->grad[q];
        const double                jxw        = state.cell->jxw[q];
        const double                eps        = state.value(state.eps, phi);
        const double                inertia    = eps * rho / state.problem.dt;
        const std::array<double, n> streamline = state.advect(grad, phi);
        std::array<double, dim>     force{};
        for (unsigned int d = 0; d < dim; ++d)
          {
            for (unsigned int v = 0; v < n; ++v)
              force[d] += inertia * phi[v] * state.u_start[v][d];
            force[d] += eps * state.problem.drive[d];
          }
        double source = 0.;
        if (state.problem.body_force || state.problem.mass_source)
          {
            Point<dim> x;
            for (unsigned int v = 0; v < n; ++v)
              x += phi[v] * state.cell->vertex[v];
            if (state.problem.body_force)
              for (unsigned int d = 0; d < dim; ++d)
                force[d] += state.problem.body_force->value(x, d);
            if (state.problem.mass_source)
              source = state.problem.mass_source->value(x);
          }
        for (unsigned int i = 0; i < n; ++i)
          {
            for (unsigned int d = 0; d < dim; ++d)
              {
                b[i * (dim + 1) + d] += jxw * (phi[i] + supg * streamline[i]) * force[d];
                b[i * (dim + 1) + dim] += jxw * pspg * grad[i][d] * force[d];
              }
            b[i * (dim + 1) + dim] += jxw * phi[i] * source;
          }
      }
  }


  template <int dim, int n>
  void term_squares(const CellState<dim, n> &state, const BlockVector &x, double &momentum, double &continuity)
  {
    for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
      {
        const auto             &phi = state.space.shape_values()[q];
        const double            e   = state.value(state.eps, phi);
        std::array<double, dim> grad_p{}, flux{};
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            {
              grad_p[d] += x.block(1).local_element(state.cell->pressure[v]) * state.cell->grad[q][v][d];
              flux[d] += e * phi[v] * x.block(0).local_element(state.cell->velocity[v][d]);
            }
        double p2 = 0., u2 = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            p2 += grad_p[d] * grad_p[d] + e * e * state.problem.drive[d] * state.problem.drive[d];
            u2 += flux[d] * flux[d];
          }
        momentum += p2 * state.cell->jxw[q] * state.cell->measure;
        continuity += u2 * state.cell->jxw[q];
      }
  }


  template void add_mesh(const CellState<2, 3> &, LocalMatrix<2, 3> &);
  template void add_mesh_right_hand_side(const CellState<2, 3> &, LocalVector<2, 3> &);
  template void term_squares(const CellState<2, 3> &, const BlockVector &, double &, double &);
  template void add_mesh(const CellState<2, 4> &, LocalMatrix<2, 4> &);
  template void add_mesh_right_hand_side(const CellState<2, 4> &, LocalVector<2, 4> &);
  template void term_squares(const CellState<2, 4> &, const BlockVector &, double &, double &);
} // namespace alluvium::fluid
