#include <alluvium/coupling/rotation.h>

namespace alluvium::coupling
{
  namespace
  {
    double cross(const std::array<double, 2> &a, const std::array<double, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }
  } // namespace


  double couple(const CouplingState &state, const std::size_t k, const VelocityGradient &L)
  {
    const auto &c = state.map.arms()[k].moments;
    return state.map.terms().shape[k].area * state.gamma[k] *
           (c[0] * L[1][0] + c[1] * (L[1][1] - L[0][0]) - c[2] * L[0][1]);
  }


  GrainTorques grain_torques(const CouplingState &state, const std::vector<std::uint8_t> &old)
  {
    const std::size_t   n_grains = state.grains.n();
    std::vector<double> sums(2 * n_grains, 0.);
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      {
        const bool         is_old = !old.empty() && old[k];
        const unsigned int g      = state.map.grain()[k];
        const PieceField  &f      = is_old ? state.old[k] : state.latest[k];
        const auto        &L      = is_old ? state.old_gradient[k] : state.latest_gradient[k];
        const auto        &arm    = state.map.arms()[k].arm;
        const auto        &c      = state.map.arms()[k].moments;
        const double       area = state.map.terms().shape[k].area, gamma = state.gamma[k];

        std::array<double, 2> push = {{gamma * (f.u[0] - state.grains.velocity[0][g]) - f.grad_p[0],
                                       gamma * (f.u[1] - state.grains.velocity[1][g]) - f.grad_p[1]}};
        if (state.added_density > 0.)
          for (unsigned int d = 0; d < 2; ++d)
            push[d] += state.added_density * (f.u[d] / state.dt + state.acceleration[k][d]);
        sums[2 * g] += area * cross(arm, push) + couple(state, k, L);
        sums[2 * g + 1] += area * gamma * (arm[0] * arm[0] + arm[1] * arm[1] + c[0] + c[2]);
      }
    state.map.sum_over_ranks(sums);
    GrainTorques result;
    for (std::size_t g = 0; g < n_grains; ++g)
      {
        result.torque.push_back(sums[2 * g]);
        result.spin_drag.push_back(sums[2 * g + 1]);
      }
    return result;
  }
} // namespace alluvium::coupling
