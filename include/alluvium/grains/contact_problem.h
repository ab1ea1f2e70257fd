#pragma once

#include <cstdint>
#include <vector>

namespace alluvium::grains
{
  /** Velocity of a disc, packed for the sweeps: s = radius * omega [m/s], so that rotation needs no lever arms. */
  struct DiscVelocity
  {
    double x = 0., y = 0., s = 0., padding = 0.;
  };

  /** What a disc's kinetic energy weighs its velocities with [kg/m]: the effective mass, and I / r^2 for s. */
  struct DiscMass
  {
    double translation, rotation;
  };

  /**
   * One contact between discs i and j (or a wall in place of j) during one sub-step. The normal points from i to j, the
   * tangent is
   * (-ny, nx), the impulse (rn, rt) acts on j and its opposite on i. With the relative velocities
   *
   *   v_n = (v_j - v_i).n                    v_t = (v_j - v_i).t - s_i - s_j
   *
   * the laws are 0 <= v_n + bias_n  _|_  rn >= 0 and Coulomb's |rt| <= mu rn against v_t + bias_t. A disc touches at
   * distance r from its centre along n, so normal and tangent do not see each other: the local problem is two clamps.
   */
  struct alignas(64) Contact
  {
    std::uint32_t i, j;
    double        nx, ny;
    double        bias_n, bias_t;                         // [m/s]
    double        rn, rt;                                 // [N s/m]
    double        last_rn, last_rt;                       // of the sweep before; the accelerated solver's own
    double        mass_n, mass_t;                         // 1 / (diagonal of the local block) [kg/m]
    double        inverse_mass_i, inverse_mass_j;         // effective, of translation [m/kg]
    double        inverse_rotation_i, inverse_rotation_j; // r^2 / I [m/kg]
    double        friction;
  };

  /**
   * All contacts of one sub-step. Walls are bodies that nothing moves: their velocity sits in the biases, and a few
   * dummy entries behind the discs stand for them in `velocity`.
   */
  struct ContactProblem
  {
    std::vector<DiscVelocity> velocity; // in: free velocities; out: with the contact impulses. n_discs + dummies
    std::vector<DiscMass>     mass;     // n_discs
    std::vector<Contact>      contacts; // in: warm impulses; out: the solution. Neighbours in the list share no disc
    double                    impulse_scale = 1.; // smallest impulse that matters [N s/m]: mean mass * g * dt, say
  };

  /** Add the velocities that the impulses in @p problem cause to its velocities. */
  void apply_impulses(ContactProblem &problem);
} // namespace alluvium::grains
