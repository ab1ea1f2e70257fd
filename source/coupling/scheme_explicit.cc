// The two schemes that freeze the grains' velocity during the fluid's step. Kept for the stability charts: sand in
// water allows them only time steps below 2 eps^2 (1-r) tau_p, r = (1-eps) rho / (eps rho_p), and none at all for r
// >= 1.
#include <alluvium/coupling/time_scheme.h>

namespace alluvium::coupling
{
  namespace
  {
    std::array<double, 2> solid_velocity(const CouplingState &state, const std::size_t k)
    {
      const unsigned int          g    = state.map.grain()[k];
      const std::array<double, 2> spin = state.spin_velocity(k);
      return {{state.grains.velocity[0][g] + spin[0], state.grains.velocity[1][g] + spin[1]}};
    }

    class Explicit : public TimeScheme
    {
    public:
      bool keeps_grain_velocity() const override { return true; }

      void exchange_terms(const CouplingState &state,
                          const unsigned int,
                          std::vector<fluid::PieceExchange<2>> &exchange) const override
      {
        for (std::size_t k = 0; k < exchange.size(); ++k)
          {
            exchange[k]       = {};
            exchange[k].a     = solid_velocity(state, k);
            exchange[k].omega = state.grains.omega[state.map.grain()[k]];
            for (unsigned int d = 0; d < 2; ++d)
              exchange[k].e[d] = state.gamma[k] * (state.old[k].u[d] - exchange[k].a[d]);
          }
      }
    };

    class ImplicitDrag : public TimeScheme
    {
    public:
      bool keeps_grain_velocity() const override { return true; }

      void exchange_terms(const CouplingState &state,
                          const unsigned int,
                          std::vector<fluid::PieceExchange<2>> &exchange) const override
      {
        for (std::size_t k = 0; k < exchange.size(); ++k)
          {
            exchange[k]       = {};
            exchange[k].gamma = state.coefficient(k); // with added mass only where grains are fixed
            exchange[k].a     = solid_velocity(state, k);
            exchange[k].omega = state.grains.omega[state.map.grain()[k]];
            exchange[k].e     = state.added_force(k);
          }
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_TIME_SCHEME(Explicit, "explicit", "Drag gamma (u^n - v^n), and v^n in the continuity equation.")
  ALLUVIUM_REGISTER_TIME_SCHEME(ImplicitDrag,
                                "implicit drag",
                                "Drag gamma (u^{n+1} - v^n), and v^n in the continuity equation.")
} // namespace alluvium::coupling
