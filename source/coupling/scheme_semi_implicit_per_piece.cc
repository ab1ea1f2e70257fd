#include <alluvium/coupling/time_scheme.h>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * The paper's scheme (12)-(15) as its own code has it: every piece of a grain predicts a velocity v* of its own,
     *   v*_k = c [rho_p v^n/dt + (m' g + F_c)/V + gamma u - grad p],   c = 1 / (rho_p/dt + gamma),   rho_p = m/V.
     * The pieces of one grain then move apart and shed drag: where a grain spans several cells, even the steady
     * solution depends on dt.
     */
    class SemiImplicitPerPiece : public TimeScheme
    {
    public:
      bool predicts_acceleration() const override { return true; }

      void exchange_terms(const CouplingState &state,
                          const unsigned int,
                          std::vector<fluid::PieceExchange<2>> &exchange) const override
      {
        const auto &grains = state.grains;
        for (std::size_t k = 0; k < exchange.size(); ++k)
          {
            const unsigned int g       = state.map.grain()[k];
            const double       volume  = state.volume(g);
            const double       inertia = grains.mass[g] / (volume * state.dt);
            const auto         weight  = state.submerged_weight(g);
            const auto         spin    = state.spin_velocity(k);
            const auto         added   = state.added_force(k);
            auto              &x       = exchange[k];
            x                          = {};
            x.gamma                    = state.coefficient(k);
            x.compliance               = 1. / (inertia + x.gamma);
            x.omega                    = x.compliance * inertia * grains.omega[g];
            x.e                        = added;
            x.a                        = {{x.compliance * (inertia * (grains.velocity[0][g] + spin[0]) +
                                    (weight[0] + grains.contact_force[0][g]) / volume + added[0]),
                                           x.compliance * (inertia * (grains.velocity[1][g] + spin[1]) +
                                    (weight[1] + grains.contact_force[1][g]) / volume + added[1])}};
          }
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_TIME_SCHEME(
    SemiImplicitPerPiece,
    "semi-implicit per piece",
    "The paper's: velocities v* predicted with the new fluid in both equations, one for every piece of a "
    "grain.")
} // namespace alluvium::coupling
