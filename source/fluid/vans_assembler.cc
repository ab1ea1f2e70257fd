#include <alluvium/fluid/bilinear_moments.h>
#include <alluvium/fluid/vans_assembler.h>

#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/block_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /**
     * The weak form on one cell with n nodes. Local unknowns are ordered node * (dim+1) + component, component dim the
     * pressure. The number of nodes is a template argument so that the compiler unrolls the loops.
     */
    template <int dim, int n>
    class CellKernel
    {
    public:
      static constexpr unsigned int n_local = n * (dim + 1);
      using LocalMatrix                     = std::array<std::array<double, n_local>, n_local>;
      using LocalVector                     = std::array<double, n_local>;

      CellKernel(const FluidSpace<dim> &space, const VansProblem<dim> &problem)
        : space(space)
        , problem(problem)
      {}

      /** Look at a cell's void fraction only: enough for term_squares(). */
      void reinit_void_fraction(const unsigned int index)
      {
        cell = &space.cells()[index];
        for (unsigned int v = 0; v < n; ++v)
          eps[v] = problem.void_fraction->local_element(cell->node[v]);
      }

      /** Read the cell's nodal values and find tau. */
      void reinit(const unsigned int index)
      {
        reinit_void_fraction(index);
        begin           = problem.solid->begin.empty() ? 0 : problem.solid->begin[index];
        end             = problem.solid->begin.empty() ? 0 : problem.solid->begin[index + 1];
        double eps_mean = 0., u_norm = 0.;
        u_mean = {};
        for (unsigned int v = 0; v < n; ++v)
          {
            eps_mean += eps[v] / n;
            for (unsigned int d = 0; d < dim; ++d)
              {
                u_old[v][d] = problem.old->block(0).local_element(cell->velocity[v][d]);
                u_start[v][d] =
                  (problem.inertia ? problem.inertia : problem.old)->block(0).local_element(cell->velocity[v][d]);
                u_mean[d] += u_old[v][d] / n;
              }
          }
        for (unsigned int d = 0; d < dim; ++d)
          u_norm += u_mean[d] * u_mean[d];
        u_norm       = problem.discretisation.convection ? std::sqrt(u_norm) : 0.;
        double sigma = 0.;
        for (unsigned int k = begin; k < end; ++k)
          sigma += problem.solid->shape[k].area * problem.solid->exchange[k].gamma;
        sigma /= cell->measure;
        const double rho_eps = problem.fluid.density * eps_mean, h = cell->size;
        const double dt      = problem.stabilisation_dt > 0. ? problem.stabilisation_dt : problem.dt;
        const double inertia = 2. * rho_eps / dt, advection = 2. * rho_eps * u_norm / h,
                     diffusion = 12. * eps_mean * problem.fluid.viscosity / (h * h), drag = 2. * sigma;
        const double tau =
          1. / std::sqrt(inertia * inertia + advection * advection + diffusion * diffusion + drag * drag + 1e-300);
        pspg = tau * eps_mean;
        supg = problem.discretisation.convection ? tau * rho_eps : 0.;
      }

      bool has_pieces() const { return end > begin; }

      void matrix(LocalMatrix &L) const
      {
        for (auto &row : L)
          row.fill(0.);
        add_mesh(L);
        add_pieces(L);
      }

      /** The terms integrated over the cell. */
      void add_mesh(LocalMatrix &L) const
      {
        const double rho = problem.fluid.density, eta = problem.fluid.viscosity, dt = problem.dt;
        for (unsigned int q = 0; q < space.n_q_points(); ++q)
          {
            const auto  &phi  = space.shape_values()[q];
            const auto  &grad = cell->grad[q];
            const double jxw  = cell->jxw[q];
            const double e = value(eps, phi), er = e * rho, e_eta = e * eta;
            // rate[j] = (d/dt + u^n.grad) of shape function j; test[i] = Galerkin + SUPG weight
            std::array<double, n> rate, test, streamline = advect(grad, phi);
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

      /**
       * The terms of the pieces: drag, the solid's share of the pressure gradient, its velocity in the continuity
       * equation. On parallelograms their moments are added up first.
       */
      void add_pieces(LocalMatrix &L) const
      {
        const bool   by_moments = n == 4 && cell->parallelogram && problem.discretisation.lumped_drag;
        PieceMoments moments;
        for (unsigned int k = begin; k < end; ++k)
          {
            const PieceShape<dim>    &s = problem.solid->shape[k];
            const PieceExchange<dim> &x = problem.solid->exchange[k];
            const double              b = x.gamma * x.compliance;
            PieceFactors              f;
            f.drag   = s.area * x.gamma * (1. - b);
            f.lift   = s.area * (1. - b);
            f.flux_u = pspg * f.drag - s.area * b;
            f.flux_p = s.area * x.compliance - pspg * f.lift;
            if (by_moments)
              moments.add(f, s);
            else
              add_shape(s, f, L);
            if constexpr (dim == 2)
              if (!problem.solid->spin.empty())
                add_spin(k, f.drag, L);
          }
        if constexpr (n == 4)
          if (by_moments && has_pieces())
            add_moments(moments, L);
      }

      /**
       * Drag around the centroid of piece @p k, so that it sees the fluid turn: gamma integral of (x - c).grad phi_i
       * (x - c).grad phi_j. Lumping would also hold back a turning fluid, as if the grain were as large as the cell:
       * that part of it, the projection on rotations of the cell's nodes, is taken out.
       */
      void add_spin(const unsigned int k, const double drag, LocalMatrix &L) const
      {
        const PieceShape<dim> &s     = problem.solid->shape[k];
        const PieceSpin       &spin  = problem.solid->spin[k];
        const auto             grad  = piece_gradients<n>(*cell, s.phi);
        const auto             arms  = spin_arms(grad, spin);
        const auto            &x     = problem.solid->exchange[k];
        const double           gamma = s.area * spin.gamma * (1. - x.gamma * x.compliance);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            for (unsigned int c = 0; c < dim; ++c)
              L[i * (dim + 1) + c][j * (dim + 1) + c] += gamma * (arms[i][0] * grad[j][0] + arms[i][1] * grad[j][1]);
        if (!problem.discretisation.lumped_drag)
          return;
        const auto turn = rotation_of_nodes(s);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int j = 0; j < n; ++j)
              for (unsigned int d = 0; d < dim; ++d)
                L[i * (dim + 1) + c][j * (dim + 1) + d] -= drag * turn[i][c] * turn[j][d];
      }

      /** Add the terms known from the mesh: u^n/dt, body force, mass source. */
      void known_mesh(LocalVector &b) const
      {
        const double rho = problem.fluid.density;
        for (unsigned int q = 0; q < space.n_q_points(); ++q)
          {
            const auto                 &phi        = space.shape_values()[q];
            const auto                 &grad       = cell->grad[q];
            const double                jxw        = cell->jxw[q];
            const double                inertia    = value(eps, phi) * rho / problem.dt;
            const std::array<double, n> streamline = advect(grad, phi);
            std::array<double, dim>     force{};
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int v = 0; v < n; ++v)
                force[d] += inertia * phi[v] * u_start[v][d];
            double source = 0.;
            if (problem.body_force || problem.mass_source)
              {
                Point<dim> x;
                for (unsigned int v = 0; v < n; ++v)
                  x += phi[v] * cell->vertex[v];
                if (problem.body_force)
                  for (unsigned int d = 0; d < dim; ++d)
                    force[d] += problem.body_force->value(x, d);
                if (problem.mass_source)
                  source = problem.mass_source->value(x);
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

      /** Add the terms that the pieces know: a, e and u_ref. */
      void known_pieces(LocalVector &r) const
      {
        if (!has_pieces())
          return;
        // the reference velocities' nodal values
        std::array<std::array<std::array<double, n>, dim>, 3> reference{};
        for (unsigned int i = 0; i < reference.size(); ++i)
          if (problem.reference[i])
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int d = 0; d < dim; ++d)
                reference[i][d][v] = problem.reference[i]->local_element(cell->velocity[v][d]);
        const bool lumped = problem.discretisation.lumped_drag;
        const bool affine = n == 4 && cell->parallelogram;
        // of drag b on each reference velocity, and times its mean over the piece, against shape functions
        std::array<std::array<double, n>, 3>   lumped_drag{};
        std::array<std::array<double, n>, dim> lumped_mean{};
        KnownSums                              sums{};
        for (unsigned int k = begin; k < end; ++k)
          {
            const PieceShape<dim>    &s = problem.solid->shape[k];
            const PieceExchange<dim> &x = problem.solid->exchange[k];
            const double              b = problem.reference[x.reference] ? x.gamma * x.compliance : 0.;
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
                    const double mean = value(reference[x.reference][d], s.phi);
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
              add_known(s, velocity, force, r);
            if constexpr (dim == 2)
              if (!problem.solid->spin.empty())
                known_spin(k, r);
          }
        if constexpr (n == 4)
          if (affine)
            add_known(sums, r);
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

      void known_spin(const unsigned int k, LocalVector &r) const
      {
        const PieceShape<dim>    &s     = problem.solid->shape[k];
        const PieceExchange<dim> &x     = problem.solid->exchange[k];
        const PieceSpin          &spin  = problem.solid->spin[k];
        const auto                grad  = piece_gradients<n>(*cell, s.phi);
        const auto                arms  = spin_arms(grad, spin);
        const double              gamma = s.area * spin.gamma, b = x.gamma * x.compliance;
        const Vector             *reference = b == 0. ? nullptr : problem.reference[x.reference];
        // the known part of the solid's velocity gradient
        std::array<std::array<double, 2>, 2> known = {{{{0., -x.omega}}, {{x.omega, 0.}}}};
        if (reference)
          for (unsigned int v = 0; v < n; ++v)
            for (unsigned int c = 0; c < 2; ++c)
              for (unsigned int d = 0; d < 2; ++d)
                known[c][d] -= b * reference->local_element(cell->velocity[v][c]) * grad[v][d];
        for (unsigned int i = 0; i < n; ++i)
          {
            for (unsigned int c = 0; c < 2; ++c)
              r[i * (dim + 1) + c] += gamma * (arms[i][0] * known[c][0] + arms[i][1] * known[c][1]);
            // a disc that turns displaces nothing: exactly, if the centroids' velocities are left out
            r[i * (dim + 1) + dim] -= s.area * x.omega * (grad[i][1] * spin.arm[0] - grad[i][0] * spin.arm[1]);
          }
        if (!problem.discretisation.lumped_drag || !reference)
          return;
        const auto turn  = rotation_of_nodes(s);
        double     omega = 0.;
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            omega += turn[v][d] * reference->local_element(cell->velocity[v][d]);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int d = 0; d < dim; ++d)
            r[i * (dim + 1) + d] += s.area * x.gamma * b * turn[i][d] * omega;
      }

      /** Sums over the rows of each equation of the squares of its largest terms: grad p, and eps u.grad q. */
      void term_squares(const BlockVector &x, double &momentum, double &continuity) const
      {
        for (unsigned int q = 0; q < space.n_q_points(); ++q)
          {
            const auto             &phi = space.shape_values()[q];
            const double            e   = value(eps, phi);
            std::array<double, dim> grad_p{}, flux{};
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int d = 0; d < dim; ++d)
                {
                  grad_p[d] += x.block(1).local_element(cell->pressure[v]) * cell->grad[q][v][d];
                  flux[d] += e * phi[v] * x.block(0).local_element(cell->velocity[v][d]);
                }
            double p2 = 0., u2 = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                p2 += grad_p[d] * grad_p[d];
                u2 += flux[d] * flux[d];
              }
            momentum += p2 * cell->jxw[q] * cell->measure;
            continuity += u2 * cell->jxw[q];
          }
      }

      /** The cell's values of @p x in the local order. */
      LocalVector values(const BlockVector &x) const
      {
        LocalVector result;
        for (unsigned int v = 0; v < n; ++v)
          {
            for (unsigned int d = 0; d < dim; ++d)
              result[v * (dim + 1) + d] = x.block(0).local_element(cell->velocity[v][d]);
            result[v * (dim + 1) + dim] = x.block(1).local_element(cell->pressure[v]);
          }
        return result;
      }

    private:
      /** The second moments of a piece times the gradient of each shape function. */
      template <typename Gradients>
      std::array<std::array<double, dim>, n> spin_arms(const Gradients &grad, const PieceSpin &spin) const
      {
        std::array<std::array<double, dim>, n> arms;
        for (unsigned int v = 0; v < n; ++v)
          arms[v] = {{spin.moments[0] * grad[v][0] + spin.moments[1] * grad[v][1],
                      spin.moments[1] * grad[v][0] + spin.moments[2] * grad[v][1]}};
        return arms;
      }

      /**
       * phi_i ez x (x_i - c) over the root of sum phi_i |x_i - c|^2: nodal velocities are projected on a rotation about
       * the piece's centroid c by its inner product with them.
       */
      std::array<std::array<double, dim>, n> rotation_of_nodes(const PieceShape<dim> &s) const
      {
        Point<dim> centroid;
        for (unsigned int v = 0; v < n; ++v)
          centroid += s.phi[v] * cell->vertex[v];
        std::array<std::array<double, dim>, n> turn;
        double                                 square = 0.;
        for (unsigned int v = 0; v < n; ++v)
          {
            const Tensor<1, dim> arm = cell->vertex[v] - centroid;
            square += s.phi[v] * arm.norm_square();
            turn[v] = {{-s.phi[v] * arm[1], s.phi[v] * arm[0]}};
          }
        const double factor = square > 1e-20 * cell->measure ? 1. / std::sqrt(square) : 0.;
        for (auto &t : turn)
          for (double &component : t)
            component *= factor;
        return turn;
      }

      /** What a piece's shape is multiplied by in the matrix. */
      struct PieceFactors
      {
        double drag, lift, flux_u, flux_p;
      };

      /** The same, summed over the pieces of a parallelogram. */
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

      void add_shape(const PieceShape<dim> &s, const PieceFactors &f, LocalMatrix &L) const
      {
        const auto                  grad   = piece_gradients<n>(*cell, s.phi);
        const std::array<double, n> weight = piece_weight(s, grad);
        const bool                  lumped = problem.discretisation.lumped_drag;
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

      void add_moments(PieceMoments &moments, LocalMatrix &L) const
      {
        for (auto *m : {&moments.drag, &moments.lift, &moments.flux_u, &moments.flux_p})
          m->close();
        const auto grad = gradient_factors(*cell);
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

      void add_known(const PieceShape<dim>         &s,
                     const std::array<double, dim> &velocity,
                     const std::array<double, dim> &force,
                     LocalVector                   &r) const
      {
        const auto                  grad   = piece_gradients<n>(*cell, s.phi);
        const std::array<double, n> weight = piece_weight(s, grad);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int d = 0; d < dim; ++d)
            {
              r[i * (dim + 1) + d] += force[d] * weight[i];
              r[i * (dim + 1) + dim] += grad[i][d] * (velocity[d] + pspg * force[d]);
            }
      }

      void add_known(const KnownSums &sums, LocalVector &r) const
      {
        const auto grad = gradient_factors(*cell);
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

      template <typename Values>
      double value(const std::array<double, n> &nodal, const Values &phi) const
      {
        double sum = 0.;
        for (unsigned int v = 0; v < n; ++v)
          sum += nodal[v] * phi[v];
        return sum;
      }

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

      template <typename Gradients>
      std::array<double, n> piece_weight(const PieceShape<dim> &s, const Gradients &grad) const
      {
        std::array<double, n> weight;
        for (unsigned int v = 0; v < n; ++v)
          {
            double streamline = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              streamline += u_mean[d] * grad[v][d];
            weight[v] = s.phi[v] + supg * streamline;
          }
        return weight;
      }

      const FluidSpace<dim>  &space;
      const VansProblem<dim> &problem;

      unsigned int                           begin = 0, end = 0;
      const CellData<dim>                   *cell = nullptr;
      std::array<double, n>                  eps;
      std::array<std::array<double, dim>, n> u_old, u_start;
      std::array<double, dim>                u_mean;
      double                                 pspg = 0., supg = 0.;
    };

    /** Add @p local to the entries of a cell without constraints. */
    template <int dim, typename LocalVector>
    void add_to(BlockVector &vector, const CellData<dim> &cell, const LocalVector &local)
    {
      for (unsigned int v = 0; v < local.size() / (dim + 1); ++v)
        {
          for (unsigned int d = 0; d < dim; ++d)
            vector.block(0).local_element(cell.velocity[v][d]) += local[v * (dim + 1) + d];
          vector.block(1).local_element(cell.pressure[v]) += local[v * (dim + 1) + dim];
        }
    }

    /** Call @p action with the kernel for the mesh's kind of cell. */
    template <int dim, typename Action>
    void with_kernel(const FluidSpace<dim> &space, const VansProblem<dim> &problem, const Action &action)
    {
      if (space.n_nodes_per_cell() == dim + 1)
        action(CellKernel<dim, dim + 1>(space, problem));
      else
        action(CellKernel<dim, (1 << dim)>(space, problem));
    }
  } // namespace


  template <int dim>
  VansAssembler<dim>::VansAssembler(const FluidSpace<dim> &space)
    : space(&space)
  {}


  template <int dim>
  void VansAssembler<dim>::reinit()
  {
    system_matrix.clear();
    TrilinosWrappers::BlockSparsityPattern pattern(
      space->owned(), space->owned(), space->relevant(), space->communicator());
    DoFTools::make_sparsity_pattern(space->dof_handler(),
                                    pattern,
                                    space->constraints(),
                                    false,
                                    Utilities::MPI::this_mpi_process(space->communicator()));
    pattern.compress();
    system_matrix.reinit(pattern);
    system_matrix.compress(VectorOperation::insert);
    scatter.reinit(*space, system_matrix);
  }


  template <int dim>
  void VansAssembler<dim>::assemble(const VansProblem<dim> &problem,
                                    const BlockVector      &iterate,
                                    BlockVector            &residual,
                                    BlockVector            &known)
  {
    system_matrix = 0.;
    residual      = 0.;
    known         = 0.;
    scatter.find_values(system_matrix);
    with_kernel<dim>(*space, problem, [&](auto kernel) {
      using K                                = decltype(kernel);
      constexpr unsigned int               n = K::n_local;
      typename K::LocalMatrix              L;
      typename K::LocalVector              b;
      FullMatrix<double>                   local_matrix(n, n);
      dealii::Vector<double>               local_residual(n), local_known(n);
      std::vector<types::global_dof_index> local_dofs(n);
      const auto                          &constraints = space->constraints();
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          const CellData<dim> &cell = space->cells()[i];
          kernel.reinit(i);
          kernel.matrix(L);
          b.fill(0.);
          kernel.known_mesh(b);
          typename K::LocalVector b_pieces{};
          kernel.known_pieces(b_pieces);
          const typename K::LocalVector x = kernel.values(iterate);
          for (unsigned int r = 0; r < n; ++r)
            for (unsigned int c = 0; c < n; ++c)
              b[r] -= L[r][c] * x[c];
          if (scatter.serves(i))
            {
              scatter.add(i, L);
              add_to(residual, cell, b);
              if (kernel.has_pieces())
                add_to(known, cell, b_pieces);
              continue;
            }
          for (unsigned int r = 0; r < n; ++r)
            {
              for (unsigned int c = 0; c < n; ++c)
                local_matrix(r, c) = L[r][c];
              local_residual(r) = b[r];
              local_known(r)    = b_pieces[r];
              local_dofs[r]     = cell.dofs[r];
            }
          constraints.distribute_local_to_global(local_matrix, local_dofs, system_matrix);
          constraints.distribute_local_to_global(local_residual, local_dofs, residual);
          if (kernel.has_pieces())
            constraints.distribute_local_to_global(local_known, local_dofs, known);
        }
      // prescribed inflow: the boundary term of the continuity equation, with the iterate's boundary values
      for (const auto &face : space->inflow_faces())
        {
          const CellData<dim> &cell = space->cells()[face.cell];
          local_residual            = 0.;
          for (unsigned int q = 0; q < face.phi.size(); ++q)
            {
              double eps = 0., flux = 0.;
              for (unsigned int v = 0; v < n / (dim + 1); ++v)
                {
                  eps += problem.void_fraction->local_element(cell.node[v]) * face.phi[q][v];
                  for (unsigned int d = 0; d < dim; ++d)
                    flux +=
                      iterate.block(0).local_element(cell.velocity[v][d]) * face.phi[q][v] * face.normal_jxw[q][d];
                }
              for (unsigned int v = 0; v < n / (dim + 1); ++v)
                local_residual(v * (dim + 1) + dim) -= eps * flux * face.phi[q][v];
            }
          for (unsigned int r = 0; r < n; ++r)
            local_dofs[r] = cell.dofs[r];
          constraints.distribute_local_to_global(local_residual, local_dofs, residual);
        }
    });
    system_matrix.compress(VectorOperation::add);
    residual.compress(VectorOperation::add);
    known.compress(VectorOperation::add);
    residual += known;
  }


  template <int dim>
  void VansAssembler<dim>::known_interphase(const VansProblem<dim> &problem, BlockVector &known) const
  {
    known = 0.;
    with_kernel<dim>(*space, problem, [&](auto kernel) {
      using K                                = decltype(kernel);
      constexpr unsigned int               n = K::n_local;
      typename K::LocalVector              b;
      dealii::Vector<double>               local(n);
      std::vector<types::global_dof_index> local_dofs(n);
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          if (problem.solid->begin[i] == problem.solid->begin[i + 1])
            continue;
          kernel.reinit(i);
          b.fill(0.);
          kernel.known_pieces(b);
          for (unsigned int r = 0; r < n; ++r)
            {
              local(r)      = b[r];
              local_dofs[r] = space->cells()[i].dofs[r];
            }
          space->constraints().distribute_local_to_global(local, local_dofs, known);
        }
    });
    known.compress(VectorOperation::add);
  }


  template <int dim>
  double VansAssembler<dim>::flux(const VansProblem<dim>  &problem,
                                  const BlockVector       &solution,
                                  const types::boundary_id id) const
  {
    double sum = 0.;
    with_kernel<dim>(*space, problem, [&](auto kernel) {
      using K                   = decltype(kernel);
      constexpr unsigned int  n = K::n_local;
      typename K::LocalMatrix L;
      typename K::LocalVector b;
      for (const auto &[i, weight] : space->weights_at(id))
        {
          kernel.reinit(i);
          kernel.matrix(L);
          b.fill(0.);
          kernel.known_mesh(b);
          kernel.known_pieces(b);
          const typename K::LocalVector x = kernel.values(solution);
          for (unsigned int v = 0; v < n / (dim + 1); ++v)
            {
              const unsigned int row = v * (dim + 1) + dim;
              double             r   = b[row];
              for (unsigned int c = 0; c < n; ++c)
                r -= L[row][c] * x[c];
              sum += weight[v] * r;
            }
        }
    });
    return Utilities::MPI::sum(sum, space->communicator());
  }


  namespace
  {
    /** Call @p action(point, force) with what the pieces put into the momentum equations of each cell's nodes. */
    template <int dim, typename Action>
    void for_each_interphase_force(const FluidSpace<dim>  &space,
                                   const VansProblem<dim> &problem,
                                   const BlockVector      &solution,
                                   const Action           &action)
    {
      with_kernel<dim>(space, problem, [&](auto kernel) {
        using K                   = decltype(kernel);
        constexpr unsigned int  n = K::n_local;
        typename K::LocalMatrix L;
        typename K::LocalVector r;
        for (unsigned int i = 0; i < space.cells().size(); ++i)
          {
            const CellData<dim> &cell = space.cells()[i];
            kernel.reinit(i);
            for (auto &row : L)
              row.fill(0.);
            r.fill(0.);
            kernel.add_pieces(L);
            kernel.known_pieces(r);
            const typename K::LocalVector x = kernel.values(solution);
            for (unsigned int v = 0; v < n / (dim + 1); ++v)
              {
                std::array<double, dim> force;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    const unsigned int row = v * (dim + 1) + d;
                    force[d]               = r[row];
                    for (unsigned int c = 0; c < n; ++c)
                      force[d] -= L[row][c] * x[c];
                  }
                action(cell.vertex[v], force);
              }
          }
      });
    }
  } // namespace


  template <int dim>
  std::array<double, dim> VansAssembler<dim>::interphase_force(const VansProblem<dim> &problem,
                                                               const BlockVector      &solution) const
  {
    std::array<double, dim> sum{};
    for_each_interphase_force(*space, problem, solution, [&](const Point<dim> &, const std::array<double, dim> &force) {
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += force[d];
    });
    for (double &s : sum)
      s = Utilities::MPI::sum(s, space->communicator());
    return sum;
  }


  template <int dim>
  double VansAssembler<dim>::interphase_torque(const VansProblem<dim> &problem, const BlockVector &solution) const
  {
    double sum = 0.;
    for_each_interphase_force(
      *space, problem, solution, [&](const Point<dim> &x, const std::array<double, dim> &force) {
        sum += x[0] * force[1] - x[1] * force[0];
      });
    return Utilities::MPI::sum(sum, space->communicator());
  }


  template <int dim>
  std::array<double, 2> VansAssembler<dim>::term_norms(const VansProblem<dim> &problem,
                                                       const BlockVector      &iterate) const
  {
    double momentum = 0., continuity = 0.;
    with_kernel<dim>(*space, problem, [&](auto kernel) {
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          kernel.reinit_void_fraction(i);
          kernel.term_squares(iterate, momentum, continuity);
        }
    });
    const MPI_Comm comm = space->communicator();
    return {{std::sqrt(Utilities::MPI::sum(momentum, comm)), std::sqrt(Utilities::MPI::sum(continuity, comm))}};
  }


  template class VansAssembler<2>;
} // namespace alluvium::fluid
