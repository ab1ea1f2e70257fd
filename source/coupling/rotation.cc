#include <alluvium/coupling/rotation.h>

#include <cmath>

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


  void add_torque_sums(const CouplingState &state, const SeenFluid fluid, GrainSums &sums, const unsigned int first)
  {
    const bool is_old = fluid == SeenFluid::old;
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      {
        const unsigned int g    = state.map.grain()[k];
        const PieceField  &f    = is_old ? state.old[k] : state.latest[k];
        const auto        &L    = is_old ? state.old_gradient[k] : state.latest_gradient[k];
        const auto        &arm  = state.map.arms()[k].arm;
        const auto        &c    = state.map.arms()[k].moments;
        const double       area = state.map.terms().shape[k].area, gamma = state.gamma[k];

        std::array<double, 2> push = {{gamma * (f.u[0] - state.grains.velocity[0][g]) - f.grad_p[0],
                                       gamma * (f.u[1] - state.grains.velocity[1][g]) - f.grad_p[1]}};
        if (state.added_density > 0.)
          for (unsigned int d = 0; d < 2; ++d)
            push[d] += state.added_density * (f.u[d] / state.dt + state.acceleration[k][d]);
        sums.of(g)[first] += area * cross(arm, push) + couple(state, k, L);
        sums.of(g)[first + 1] += area * gamma * (arm[0] * arm[0] + arm[1] * arm[1] + c[0] + c[2]);
      }
  }


  std::vector<std::array<double, 2>> periodic_shifts(const CouplingState &state, const fluid::FluidSpace<2> &space)
  {
    std::vector<std::array<double, 2>> result(state.n_pieces(), {{0., 0.}});
    const auto                         box   = space.periodic_box();
    const unsigned int                 n     = space.n_nodes_per_cell();
    const auto                        &begin = state.map.terms().begin;
    for (unsigned int d = 0; d < 2; ++d)
      if (box.length[d] > 0.)
        for (unsigned int c = 0; c < space.cells().size(); ++c)
          {
            double middle = 0.;
            for (unsigned int v = 0; v < n; ++v)
              middle += space.cells()[c].vertex[v][d] / n;
            for (unsigned int k = begin[c]; k < begin[c + 1]; ++k)
              {
                const double position = state.grains.position[d][state.map.grain()[k]] + state.map.arms()[k].arm[d];
                result[k][d]          = box.length[d] * std::round((middle - position) / box.length[d]);
              }
          }
    return result;
  }
} // namespace alluvium::coupling
