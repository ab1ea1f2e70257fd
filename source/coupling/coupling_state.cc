#include <alluvium/coupling/coupling_state.h>

namespace alluvium::coupling
{
  std::array<double, 2> PieceState::submerged_weight(const grains::GrainArrays &grains, const std::size_t g) const
  {
    const double volume = grains::disc_volume(grains.fluid_radius[g]), m = grains.mass[g] - fluid_density * volume;
    return {{m * gravity[0] + volume * unsupported[0], m * gravity[1] + volume * unsupported[1]}};
  }


  std::array<double, 2> CouplingState::added_force(const std::size_t k) const
  {
    if (added_density == 0.)
      return {{0., 0.}};
    const unsigned int          g    = map.grain()[k];
    const std::array<double, 2> spin = spin_velocity(k);
    return {{added_density * (acceleration[k][0] + (grains.velocity[0][g] + spin[0]) / dt),
             added_density * (acceleration[k][1] + (grains.velocity[1][g] + spin[1]) / dt)}};
  }


  std::array<double, 2> CouplingState::spin_velocity(const std::size_t k, const double omega) const
  {
    if (!couples_spin())
      return {{0., 0.}};
    const auto &arm = map.arms()[k].arm;
    return {{-omega * arm[1], omega * arm[0]}};
  }


  std::array<double, 2> CouplingState::spin_velocity(const std::size_t k) const
  {
    return spin_velocity(k, grains.omega[map.grain()[k]]);
  }
} // namespace alluvium::coupling
