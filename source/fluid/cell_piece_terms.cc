#include <alluvium/fluid/bilinear_moments.h>
#include <alluvium/fluid/cell_piece_terms.h>
#include <alluvium/fluid/cell_spin_terms.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** What a piece's shape is multiplied by in the matrix. */
    struct PieceFactors
    {
      double drag, lift, flux_u, flux_p;
    };

    /** The same, summed over the pieces of a parallelogram. */
    template <int dim>
    struct PieceMoments
    {
      BilinearMoments drag, lift, flux_u, flux_p;

      void add(const PieceFactors &f, const PieceShape<dim> &s)
      {
        drag.add(f.drag, s.phi);
        lift.add(f.lift, s.phi);
        flux_u.add(f.flux_u, s.phi);
        flux_p.add(f.flux_p, s.phi);
      }
    };

    /** Known velocities [m^3/s] times b = (1, xi, eta) and forces [N/m] times (1, xi, eta, mean of xi eta). */
    template <int dim>
    struct KnownSums
    {
      std::array<std::array<double, 3>, dim> velocity;
      std::array<std::array<double, 4>, dim> force;

      template <typename Means>
      void add(const std::array<double, dim> &v, const std::array<double, dim> &f, const Means &phi)
      {
        const double xi = phi[1] + phi[3], eta = phi[2] + phi[3];
        for (unsigned int d = 0; d < dim; ++d)
          {
            velocity[d][0] += v[d];
            velocity[d][1] += v[d] * xi;
            velocity[d][2] += v[d] * eta;
            force[d][0] += f[d];
            force[d][1] += f[d] * xi;
            force[d][2] += f[d] * eta;
            force[d][3] += f[d] * phi[3];
          }
      }
    };

    template <int dim, int n, typename Gradients>
    inline std::array<double, n>
    piece_weight(const CellState<dim, n> &state, const PieceShape<dim> &s, const Gradients &grad)
    {
      std::array<double, n> weight;
      for (unsigned int v = 0; v < n; ++v)
        {
          double streamline = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            streamline += state.u_mean[d] * grad[v][d];
          weight[v] = s.phi[v] + state.supg * streamline;
        }
      return weight;
    }

    template <int dim, int n>
    void
    add_shape(const CellState<dim, n> &state, const PieceShape<dim> &s, const PieceFactors &f, LocalMatrix<dim, n> &L)
    {
      const auto                  grad   = piece_gradients<n>(*state.cell, s.phi);
      const std::array<double, n> weight = piece_weight(state, s, grad);
      const bool                  lumped = state.problem.discretisation.lumped_drag;
      for (unsigned int i = 0; i < n; ++i)
        {
          if (lumped)
            for (unsigned int c = 0; c < dim; ++c)
              L[i * (dim + 1) + c][i * (dim + 1) + c] += f.drag * s.phi[i];
          const double drag_test = f.drag * (lumped ? weight[i] - s.phi[i] : weight[i]);
          for (unsigned int j = 0; j < n; ++j)
            {
              double grad_grad = 0.;
              for (unsigned int c = 0; c < dim; ++c)
                {
                  grad_grad += grad[i][c] * grad[j][c];
                  L[i * (dim + 1) + c][j * (dim + 1) + c] += drag_test * s.phi[j];
                  L[i * (dim + 1) + c][j * (dim + 1) + dim] -= f.lift * weight[i] * grad[j][c];
                  L[i * (dim + 1) + dim][j * (dim + 1) + c] += f.flux_u * grad[i][c] * s.phi[j];
                }
              L[i * (dim + 1) + dim][j * (dim + 1) + dim] += f.flux_p * grad_grad;
            }
        }
    }

    template <int dim, int n>
    void add_moments(const CellState<dim, n> &state, PieceMoments<dim> &moments, LocalMatrix<dim, n> &L)
    {
      const double supg   = state.supg;
      const auto   u_mean = state.u_mean;
      for (auto *m : {&moments.drag, &moments.lift, &moments.flux_u, &moments.flux_p})
        m->close();
      const auto grad = gradient_factors(*state.cell);
      const auto drag = moments.drag.shapes(), lift = moments.lift.shapes(), flux_u = moments.flux_u.shapes();
      for (unsigned int i = 0; i < n; ++i)
        {
          // the streamline-upwind part of test function i, and pressure's weight with it
          BilinearMoments::Linear upwind{};
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              upwind[k] += supg * u_mean[d] * grad[i][d][k];
          const auto                               upwind_lift = moments.lift.linear(upwind);
          std::array<BilinearMoments::Linear, dim> flux_p;
          BilinearMoments::Linear                  weight;
          for (unsigned int d = 0; d < dim; ++d)
            flux_p[d] = moments.flux_p.linear(grad[i][d]);
          for (unsigned int k = 0; k < 3; ++k)
            weight[k] = lift[i][k] + upwind_lift[k];
          for (unsigned int c = 0; c < dim; ++c)
            L[i * (dim + 1) + c][i * (dim + 1) + c] += drag[i][0];
          for (unsigned int j = 0; j < n; ++j)
            {
              const double drag_test = BilinearMoments::dot(upwind, drag[j]);
              double       grad_grad = 0.;
              for (unsigned int c = 0; c < dim; ++c)
                {
                  L[i * (dim + 1) + c][j * (dim + 1) + c] += drag_test;
                  L[i * (dim + 1) + c][j * (dim + 1) + dim] -= BilinearMoments::dot(weight, grad[j][c]);
                  L[i * (dim + 1) + dim][j * (dim + 1) + c] += BilinearMoments::dot(flux_u[j], grad[i][c]);
                  grad_grad += BilinearMoments::dot(flux_p[c], grad[j][c]);
                }
              L[i * (dim + 1) + dim][j * (dim + 1) + dim] += grad_grad;
            }
        }
    }

    template <int dim, int n>
    void add_known(const CellState<dim, n>       &state,
                   const PieceShape<dim>         &s,
                   const std::array<double, dim> &velocity,
                   const std::array<double, dim> &force,
                   LocalVector<dim, n>           &r)
    {
      const auto                  grad   = piece_gradients<n>(*state.cell, s.phi);
      const std::array<double, n> weight = piece_weight(state, s, grad);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            r[i * (dim + 1) + d] += force[d] * weight[i];
            r[i * (dim + 1) + dim] += grad[i][d] * (velocity[d] + state.pspg * force[d]);
          }
    }

    template <int dim, int n>
    void add_known(const CellState<dim, n> &state, const KnownSums<dim> &sums, LocalVector<dim, n> &r)
    {
      const double pspg = state.pspg, supg = state.supg;
      const auto   u_mean = state.u_mean;
      const auto   grad   = gradient_factors(*state.cell);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const auto                   &f     = sums.force[d];
          const std::array<double, 4>   shape = {{f[0] - f[1] - f[2] + f[3], f[1] - f[3], f[2] - f[3], f[3]}};
          const BilinearMoments::Linear force = {{f[0], f[1], f[2]}};
          BilinearMoments::Linear       flux;
          for (unsigned int k = 0; k < 3; ++k)
            flux[k] = sums.velocity[d][k] + pspg * force[k];
          for (unsigned int i = 0; i < n; ++i)
            {
              r[i * (dim + 1) + d] += shape[i];
              for (unsigned int c = 0; c < dim; ++c)
                r[i * (dim + 1) + d] += supg * u_mean[c] * BilinearMoments::dot(force, grad[i][c]);
              r[i * (dim + 1) + dim] += BilinearMoments::dot(flux, grad[i][d]);
            }
        }
    }
  } // namespace


  template <int dim, int n>
  void add_pieces(const CellState<dim, n> &state, LocalMatrix<dim, n> &L)
  {
    const bool        by_moments = n == 4 && state.cell->parallelogram && state.problem.discretisation.lumped_drag;
    PieceMoments<dim> moments;
    const double      pspg = state.pspg;
    for (unsigned int k = state.begin; k < state.end; ++k)
      {
        const PieceShape<dim>    &s = state.problem.solid->shape[k];
        const PieceExchange<dim> &x = state.problem.solid->exchange[k];
        const double              b = x.gamma * x.compliance;
        PieceFactors              f;
        f.drag   = s.area * x.gamma * (1. - b);
        f.lift   = s.area * (1. - b);
        f.flux_u = pspg * f.drag - s.area * b;
        f.flux_p = s.area * x.compliance - pspg * f.lift;
        if (by_moments)
          moments.add(f, s);
        else
          add_shape(state, s, f, L);
        if constexpr (dim == 2)
          if (!state.problem.solid->spin.empty())
            add_spin(state, k, f.drag, L);
      }
    if constexpr (n == 4)
      if (by_moments && state.has_pieces())
        add_moments(state, moments, L);
  }


  template <int dim, int n>
  void known_pieces(const CellState<dim, n> &state, LocalVector<dim, n> &r)
  {
    if (!state.has_pieces())
      return;
    // the reference velocities' nodal values
    std::array<std::array<std::array<double, n>, dim>, 3> reference{};
    for (unsigned int i = 0; i < reference.size(); ++i)
      if (state.problem.reference[i])
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            reference[i][d][v] = state.problem.reference[i]->local_element(state.cell->velocity[v][d]);
    const bool lumped = state.problem.discretisation.lumped_drag;
    const bool affine = n == 4 && state.cell->parallelogram;
    // of drag b on each reference velocity, and times its mean over the piece, against shape functions
    std::array<std::array<double, n>, 3>   lumped_drag{};
    std::array<std::array<double, n>, dim> lumped_mean{};
    KnownSums<dim>                         sums{};
    for (unsigned int k = state.begin; k < state.end; ++k)
      {
        const PieceShape<dim>    &s = state.problem.solid->shape[k];
        const PieceExchange<dim> &x = state.problem.solid->exchange[k];
        const double              b = state.problem.reference[x.reference] ? x.gamma * x.compliance : 0.;
        std::array<double, dim>   velocity, force;
        for (unsigned int d = 0; d < dim; ++d)
          {
            velocity[d] = s.area * x.a[d];
            force[d]    = s.area * (x.gamma * x.a[d] - x.e[d]);
          }
        if (b != 0.)
          {
            const double drag = s.area * x.gamma * b;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double mean = state.value(reference[x.reference][d], s.phi);
                velocity[d] -= s.area * b * mean;
                force[d] -= drag * mean;
                for (unsigned int v = 0; v < n; ++v)
                  lumped_mean[d][v] += drag * mean * s.phi[v];
              }
            for (unsigned int v = 0; v < n; ++v)
              lumped_drag[x.reference][v] += drag * s.phi[v];
          }
        if (affine)
          sums.add(velocity, force, s.phi);
        else
          add_known<dim, n>(state, s, velocity, force, r);
        if constexpr (dim == 2)
          if (!state.problem.solid->spin.empty())
            known_spin(state, k, r);
      }
    if constexpr (n == 4)
      if (affine)
        add_known<dim, n>(state, sums, r);
    if (lumped)
      for (unsigned int v = 0; v < n; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          {
            double sum = lumped_mean[d][v];
            for (unsigned int i = 0; i < reference.size(); ++i)
              sum -= lumped_drag[i][v] * reference[i][d][v];
            r[v * (dim + 1) + d] += sum;
          }
  }


  template void add_pieces(const CellState<2, 3> &, LocalMatrix<2, 3> &);
  template void known_pieces(const CellState<2, 3> &, LocalVector<2, 3> &);
  template void add_pieces(const CellState<2, 4> &, LocalMatrix<2, 4> &);
  template void known_pieces(const CellState<2, 4> &, LocalVector<2, 4> &);
} // namespace alluvium::fluid
