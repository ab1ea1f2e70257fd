#pragma once

#include <alluvium/coupling/grain_motion.h>
#include <alluvium/coupling/piece_field.h>

#include <cstdint>

namespace alluvium::coupling
{
  /**
   * What a coupled step knows of pieces (intersections of grains and cells) and of the scene: it outlives the call that
   * has found it, for the step may be repeated. Per-piece arrays follow the overlap map.
   */
  struct PieceState
  {
    double                    dt            = 0.;         // [s]
    std::array<double, 2>     gravity       = {{0., 0.}}; // [m/s^2]
    std::array<double, 2>     unsupported   = {{0., 0.}}; // VansSolver::unsupported_weight() [N/m^3]
    double                    fluid_density = 0.;         // [kg/m^3]
    std::vector<std::uint8_t> touched;                    // per grain: had a contact impulse in the last step

    std::vector<double>     gamma;                      // drag [N s/m^4]
    std::vector<PieceField> old, latest, before_latest; // t^n on the new pieces; after the latest two solves
    // of the same; empty where spin is not coupled
    std::vector<VelocityGradient> old_gradient, latest_gradient, before_latest_gradient;

    // Added mass C_m rho per volume of grain [kg/m^3] and, per piece, the fluid's acceleration but for du/dt: u.grad u
    // - u^n/dt [m/s^2]; zero and empty where it is off.
    double                             added_density = 0.;
    std::vector<std::array<double, 2>> acceleration;

    /** Weight less buoyancy [N/m]: gravity acts on the grain, the hydrostatic part of the pressure is not in p. */
    std::array<double, 2> submerged_weight(const grains::GrainArrays &grains, const std::size_t g) const;
  };


  /** All that a time scheme may know at the start of a solve, as long as that lasts. Per-grain arrays follow the
   * grains. */
  struct CouplingState : PieceState
  {
    /** @p pieces: what is known already, or memory to be filled, which is cheaper than fresh memory. */
    CouplingState(const grains::GrainArrays &grains, const OverlapMap &map, PieceState &&pieces)
      : PieceState(std::move(pieces))
      , grains(grains)
      , map(map)
    {}

    const grains::GrainArrays &grains; // at the beginning of the step
    const OverlapMap          &map;

    const GrainMotion *corrected_motion =
      nullptr; // what the grains made of the latest solve, where the step is repeated

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

    double                volume(const std::size_t g) const { return grains::disc_volume(grains.fluid_radius[g]); }
    std::array<double, 2> submerged_weight(const std::size_t g) const
    {
      return PieceState::submerged_weight(grains, g);
    }
    std::size_t n_pieces() const { return map.grain().size(); }
  };
} // namespace alluvium::coupling
