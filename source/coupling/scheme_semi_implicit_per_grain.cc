#include <alluvium/coupling/rotation.h>
#include <alluvium/coupling/time_scheme.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * One rigid v* per grain without the fill of a rigid coupling: a deferred correction with the factor 1/2. With
     * s_k = gamma_k u - grad p on the pieces, S = sum A s_k, G = sum A gamma_k and a known, lagged field,
     *   w    = [m v^n/dt + m' g + F_c + S(lagged)] / (m/dt + G)
     *   v*_k = w + 1/2 c_k (s_k^{n+1} - s_k(lagged)),          c_k = 1 / (rho_p/dt + gamma_k),
     * which is exactly rigid once lagged and new field agree. Sub-iteration 1 lags with the old fields on the new
     * pieces, sub-iteration 2 with sub-iteration 1, and so on; grains that touched others in the last step keep the old
     * fields, to which their contact forces belong. Even numbers of sub-iterations are stable for every dt, odd ones
     * are not. With added mass, gamma is CouplingState::coefficient() and s has CouplingState::added_force(); where
     * spin is coupled, w is a field w + omega* x r, with omega* = (I omega^n/dt + T(lagged)) / (I/dt + J) from
     * GrainTorques, or omega^n for grains that touched others. In a repeated step w is what the grains made of the
     * lagged fields, contacts included.
     */
    class SemiImplicitPerGrain : public TimeScheme
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Pairs of sub-iterations",
                          n_pairs,
                          "Half the number of fluid solves a step: they come in pairs, odd numbers are unstable.",
                          dealii::Patterns::Integer(1, 10));
        prm.declare_alias("Pairs of sub-iterations", "Pairs of sweeps");
      }

      unsigned int n_sub_iterations() const override { return 2 * n_pairs; }

      bool predicts_acceleration() const override { return true; }

      void exchange_terms(const CouplingState                  &state,
                          const unsigned int                    sub_iteration,
                          std::vector<fluid::PieceExchange<2>> &exchange) const override
      {
        const auto &grains = state.grains;
        const auto  lagged = [&](const std::size_t k) -> const PieceField  &{
          const bool keep = !state.corrected_motion && (sub_iteration == 0 || state.touched[state.map.grain()[k]]);
          return keep ? state.old[k] : state.latest[k];
        };
        const GrainMotion known =
          state.corrected_motion ? *state.corrected_motion : predicted_motion(state, lagged, sub_iteration);
        for (std::size_t k = 0; k < exchange.size(); ++k)
          {
            const unsigned int      g    = state.map.grain()[k];
            const auto              spin = state.spin_velocity(k, known.omega[g]);
            const PieceField       &f    = lagged(k);
            fluid::PieceExchange<2> x;
            x.gamma      = state.coefficient(k);
            x.compliance = 0.5 / (grains.mass[g] / (state.volume(g) * state.dt) + x.gamma);
            x.a          = {{known.velocity[0][g] + spin[0] + x.compliance * f.grad_p[0],
                             known.velocity[1][g] + spin[1] + x.compliance * f.grad_p[1]}};
            x.e          = state.added_force(k);
            x.omega      = known.omega[g];
            x.reference  = &f == &state.old[k] ? 1 : 2;
            exchange[k]  = x;
          }
      }

      unsigned int n_load_sums() const override { return 3; }

      void add_load_sums(const CouplingState &state, GrainSums &sums, const unsigned int first) const override
      {
        add_sums(
          state, [&](const std::size_t k) -> const PieceField & { return state.latest[k]; }, sums, first);
      }

      void loads(const CouplingState &state,
                 const std::vector<std::array<double, 2>> &,
                 const GrainSums    &sums,
                 const unsigned int  first,
                 grains::GrainLoads &loads) const override
      {
        for (std::size_t g = 0; g < state.grains.n(); ++g)
          {
            const auto    weight = state.submerged_weight(g);
            const double *sum    = sums.of(g) + first;
            loads.force[0][g]    = weight[0] + sum[0];
            loads.force[1][g]    = weight[1] + sum[1];
            loads.drag[g]        = sum[2];
          }
        if (state.added_density == 0.)
          return;
        // the grain's own acceleration is not a force but mass: C_m rho V (v^n - v) / dt is in sums and drag
        loads.added_mass.resize(state.grains.n());
        for (std::size_t g = 0; g < state.grains.n(); ++g)
          {
            const double mass   = state.added_density * state.volume(g);
            loads.added_mass[g] = mass;
            loads.force[0][g] -= mass / state.dt * state.grains.velocity[0][g];
            loads.force[1][g] -= mass / state.dt * state.grains.velocity[1][g];
            loads.drag[g] -= mass / state.dt;
          }
      }

    private:
      /** w and omega* of the class's comment. */
      template <typename Field>
      static GrainMotion
      predicted_motion(const CouplingState &state, const Field &lagged, const unsigned int sub_iteration)
      {
        const auto &grains    = state.grains;
        const bool  with_spin = state.couples_spin();
        GrainMotion motion{grains.velocity, grains.omega};
        GrainSums   sums(grains.n(), with_spin ? 3 + n_torque_sums : 3);
        add_sums(state, lagged, sums, 0);
        if (with_spin)
          add_torque_sums(state, sub_iteration == 0 ? SeenFluid::old : SeenFluid::latest, sums, 3);
        sums.complete(state.map.communicator());
        for (std::size_t g = 0; g < grains.n(); ++g)
          {
            const double *sum     = sums.of(g);
            const double  inertia = grains.mass[g] / state.dt, denominator = inertia + sum[2];
            const auto    weight = state.submerged_weight(g);
            for (unsigned int d = 0; d < 2; ++d)
              motion.velocity[d][g] =
                (inertia * grains.velocity[d][g] + weight[d] + grains.contact_force[d][g] + sum[d]) / denominator;
            if (with_spin && !state.touched[g] && !std::isinf(grains.mass[g]))
              {
                const double turning = grains::disc_inertia(grains.mass[g], grains.radius[g]) / state.dt;
                motion.omega[g]      = (turning * grains.omega[g] + sum[3]) / (turning + sum[4]);
              }
          }
        return motion;
      }

      /** S_x, S_y [N/m], what spin takes from them included, and G [N s/m^2] of every grain. */
      template <typename Field>
      static void add_sums(const CouplingState &state, const Field &field, GrainSums &sums, const unsigned int first)
      {
        for (std::size_t k = 0; k < state.n_pieces(); ++k)
          {
            const double      area  = state.map.terms().shape[k].area;
            const double      gamma = state.coefficient(k);
            const PieceField &f     = field(k);
            const auto        spin  = state.spin_velocity(k);
            const auto        added = state.added_force(k);
            double           *sum   = sums.of(state.map.grain()[k]) + first;
            for (unsigned int d = 0; d < 2; ++d)
              sum[d] += area * (gamma * (f.u[d] - spin[d]) + added[d] - f.grad_p[d]);
            sum[2] += area * gamma;
          }
      }

      unsigned int n_pairs = 1;
    };
  } // namespace

  ALLUVIUM_REGISTER_TIME_SCHEME(
    SemiImplicitPerGrain,
    "semi-implicit per grain",
    "Velocities v* predicted with the new fluid in both equations, one rigid velocity for every grain; "
    "the grains' own step takes the drag implicitly. Contact forces are those of the last step.")
} // namespace alluvium::coupling
