#pragma once

#include <alluvium/coupling/overlap_map.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::coupling
{
  /** Fluid velocity [m/s] and reduced pressure gradient [Pa/m] at one piece. */
  struct PieceField
  {
    std::array<double, 2> u, grad_p;
  };

  /** Mean velocity and pressure gradient of @p field over each piece of @p map. */
  void evaluate(const OverlapMap           &map,
                const fluid::FluidSpace<2> &space,
                const fluid::BlockVector   &field,
                std::vector<PieceField>    &result);

  /** Gradient of the fluid velocity at a piece's centroid, [component][direction] [1/s]. */
  using VelocityGradient = std::array<std::array<double, 2>, 2>;
  std::vector<VelocityGradient>
  velocity_gradients(const OverlapMap &map, const fluid::FluidSpace<2> &space, const fluid::BlockVector &field);

  /** How grains moved in a step: mean velocities [m/s], spin at its end [rad/s]. */
  struct GrainMotion
  {
    std::vector<double> vx, vy, omega;
  };

  /** All that a time scheme may know at the start of a step. Per-piece arrays follow the overlap map, per-grain ones
   * the grains. */
  struct CouplingState
  {
    CouplingState(const grains::GrainArrays       &grains,
                  const std::vector<std::uint8_t> &touched,
                  const OverlapMap                &map,
                  const double                     dt)
      : grains(grains)
      , touched(touched)
      , map(map)
      , dt(dt)
    {}

    const grains::GrainArrays       &grains;
    const std::vector<std::uint8_t> &touched; // had a contact impulse in the last step
    const OverlapMap                &map;
    double                           dt;                         // [s]
    std::array<double, 2>            gravity       = {{0., 0.}}; // [m/s^2]
    std::array<double, 2>            unsupported   = {{0., 0.}}; // VansSolver::unsupported_weight() [N/m^3]
    double                           fluid_density = 0.;         // [kg/m^3]
    std::vector<double>              gamma;                      // drag per piece [N s/m^4]
    std::vector<PieceField>          old, latest, before_latest; // t^n on the new pieces; after the latest two sweeps

    const GrainMotion *answer = nullptr; // to the latest sweep, where the step is repeated with it

    // of the same; empty where spin is not coupled
    std::vector<VelocityGradient> old_gradient, latest_gradient, before_latest_gradient;

    // Added mass C_m rho per volume of grain [kg/m^3] and, per piece, the fluid's acceleration but for du/dt: u.grad u
    // - u^n/dt [m/s^2]; zero and empty where it is off.
    double                             added_density = 0.;
    std::vector<std::array<double, 2>> acceleration;

    /** Let the per-piece arrays live where @p other's did: fresh memory costs more than filling it. */
    void take_memory_of(CouplingState &other)
    {
      gamma.swap(other.gamma);
      old.swap(other.old);
      latest.swap(other.latest);
      before_latest.swap(other.before_latest);
    }

    /** Factor of u - v on piece @p k: drag, and what added mass makes of their difference's rate [N s/m^4]. */
    double coefficient(const std::size_t k) const { return gamma[k] + added_density / dt; }
    /**
     * What else acts on piece @p k because of added mass: C_m rho (u.grad u - u^n/dt + v^n/dt), v^n with the grain's
     * spin [N/m^3].
     */
    std::array<double, 2> added_force(const std::size_t k) const;
    /** The same on all ranks, those without pieces included. */
    bool couples_spin() const { return map.keeps_arms(); }
    /** What a spin @p omega adds to the velocity of piece @p k; zero where spin is not coupled [m/s]. */
    std::array<double, 2> spin_velocity(const std::size_t k, const double omega) const;
    /** With the spin at t^n. */
    std::array<double, 2> spin_velocity(const std::size_t k) const;

    double volume(const std::size_t g) const;
    /** Weight less buoyancy [N/m]: gravity acts on the grain, the hydrostatic part of the pressure is not in p. */
    std::array<double, 2> reduced_weight(const std::size_t g) const;
    std::size_t           n_pieces() const { return map.grain().size(); }
  };

  /**
   * Interface of the coupling schemes: they say how a piece's velocity depends on the fluid during the step, sweep by
   * sweep, and what acts on the grains afterwards.
   */
  class TimeScheme
  {
  public:
    virtual ~TimeScheme() = default;
    virtual void add_parameters(dealii::ParameterHandler &) {}

    /** Whether the grains' acceleration that the fluid sees is the one they take: added mass needs that. */
    virtual bool predicts_acceleration() const { return false; }

    /** Whether the fluid is solved with the grains' velocity of t^n: stable only at time steps below their relaxation.
     */
    virtual bool keeps_grain_velocity() const { return false; }

    /** Solves of the fluid a step; from the second on only the known terms change, the matrix stays. */
    virtual unsigned int n_sweeps() const { return 1; }

    /** How often fluid and contacts may be repeated with each other's answers, and until when; see ContactIteration. */
    struct Repetition
    {
      unsigned int largest_number = 0;
      double       tolerance      = 0.; // of Coupling::unseen_force(), see the parameter
    };
    virtual Repetition repetition() const { return {}; }

    /**
     * Fill the exchange terms of all pieces for @p sweep = 0, 1, ... Reference field 0 is none, 1 the velocity at t^n,
     * 2 that of the latest sweep. Collective.
     */
    virtual void exchange_terms(const CouplingState                  &state,
                                const unsigned int                    sweep,
                                std::vector<fluid::PieceExchange<2>> &exchange) const = 0;

    /**
     * Loads of the grains from @p force, what the fluid gave each grain [N/m], and the final state (state.latest): by
     * default the reduced weight plus that force, drag explicit.
     */
    virtual void
    loads(const CouplingState &state, const std::vector<std::array<double, 2>> &force, grains::GrainLoads &loads) const;
  };
} // namespace alluvium::coupling

/** Register a time scheme under the name that parameter files use. */
#define ALLUVIUM_REGISTER_TIME_SCHEME(Class, name, prose)                                                              \
  ALLUVIUM_REGISTER(::alluvium::coupling::TimeScheme, Class, name, prose)
