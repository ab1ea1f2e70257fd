#pragma once

#include <alluvium/coupling/time_scheme.h>

namespace alluvium::coupling
{
  /** Torques on the grains from where the fluid pushes their pieces, n grains each. */
  struct GrainTorques
  {
    std::vector<double> torque;    // on the grain if it did not turn, with the velocity of t^n [N]
    std::vector<double> spin_drag; // what each unit of its spin takes from that [N s]
  };

  /**
   * Over a piece of centroid x_k and second moments C (means), with r = x_k - centre and L = grad u,
   *   torque / A = r x (gamma (u - v - omega x r) - grad p) + gamma [C_xx L_yx + C_xy (L_yy - L_xx) - C_yy L_xy
   *                - omega (C_xx + C_yy)],
   * and with added mass r x C_m rho Du/Dt. Of piece k, @p old[k] tells whether it sees the fluid of t^n or of the
   * latest sweep; empty: all the latter. The map must have its arms. Collective.
   */
  GrainTorques grain_torques(const CouplingState &state, const std::vector<std::uint8_t> &old = {});

  /** The couple (grad u's part of the second line above, without omega's) that @p L exerts on piece @p k [N/m]. */
  double couple(const CouplingState &state, const std::size_t k, const VelocityGradient &L);
} // namespace alluvium::coupling
