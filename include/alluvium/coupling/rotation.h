#pragma once

#include <alluvium/coupling/coupling_state.h>
#include <alluvium/coupling/grain_sums.h>

namespace alluvium::coupling
{
  /** Which fluid a piece sees: that at t^n, or that of the latest solve. */
  enum class SeenFluid
  {
    old,
    latest
  };

  constexpr unsigned int n_torque_sums = 2;

  /**
   * Add to two columns of @p sums, from @p first on, the torques on the grains from where the fluid pushes their pieces
   * of this rank: that on a grain if it did not turn, with the velocity of t^n [N], and what each unit of its spin
   * takes from it [N s]. Over a piece of centroid x_k and second moments C (means), with r = x_k - centre and L = grad
   * u, torque / A = r x (gamma (u - v - omega x r) - grad p) + gamma [C_xx L_yx + C_xy (L_yy - L_xx) - C_yy L_xy
   *                - omega (C_xx + C_yy)],
   * and with added mass r x C_m rho Du/Dt. The map must have its arms.
   */
  void add_torque_sums(const CouplingState &state, const SeenFluid fluid, GrainSums &sums, const unsigned int first);

  /** The couple (grad u's part of the second line above, without omega's) that @p L exerts on piece @p k [N/m]. */
  double couple(const CouplingState &state, const std::size_t k, const VelocityGradient &L);

  /** From its grain to the image that was cut, for each piece [m]. */
  std::vector<std::array<double, 2>> periodic_shifts(const CouplingState &state, const fluid::FluidSpace<2> &space);
} // namespace alluvium::coupling
