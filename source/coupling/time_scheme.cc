#include <alluvium/coupling/time_scheme.h>

#include <deal.II/base/numbers.h>

namespace alluvium::coupling
{
  std::vector<PieceField>
  evaluate(const OverlapMap &map, const fluid::FluidSpace<2> &space, const fluid::BlockVector &field)
  {
    const auto             &terms = map.terms();
    const unsigned int      n     = space.n_nodes_per_cell();
    std::vector<PieceField> result(terms.n_pieces());
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      {
        if (terms.begin[c] == terms.begin[c + 1])
          continue;
        const auto                          &cell = space.cells()[c];
        std::array<std::array<double, 2>, 4> u;
        std::array<double, 4>                p;
        for (unsigned int v = 0; v < n; ++v)
          {
            p[v] = field.block(1).local_element(cell.pressure[v]);
            for (unsigned int d = 0; d < 2; ++d)
              u[v][d] = field.block(0).local_element(cell.velocity[v][d]);
          }
        std::size_t full = terms.n_pieces(); // all that are the whole cell have the same means
        for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
          {
            if (terms.shape[k].full && full < k)
              {
                result[k] = result[full];
                continue;
              }
            if (terms.shape[k].full)
              full = k;
            PieceField f{};
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int d = 0; d < 2; ++d)
                {
                  f.u[d] += terms.shape[k].phi[v] * u[v][d];
                  f.grad_p[d] += terms.shape[k].grad[v][d] * p[v];
                }
            result[k] = f;
          }
      }
    return result;
  }


  std::vector<VelocityGradient>
  velocity_gradients(const OverlapMap &map, const fluid::FluidSpace<2> &space, const fluid::BlockVector &field)
  {
    const auto                   &terms = map.terms();
    std::vector<VelocityGradient> result(terms.n_pieces());
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
        for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
          for (unsigned int i = 0; i < 2; ++i)
            {
              const double u = field.block(0).local_element(space.cells()[c].velocity[v][i]);
              for (unsigned int d = 0; d < 2; ++d)
                result[k][i][d] += u * terms.shape[k].grad[v][d];
            }
    return result;
  }


  std::array<double, 2> CouplingState::added_force(const std::size_t k) const
  {
    if (added_density == 0.)
      return {{0., 0.}};
    const unsigned int          g    = map.grain()[k];
    const std::array<double, 2> spin = spin_velocity(k);
    return {{added_density * (acceleration[k][0] + (grains.vx[g] + spin[0]) / dt),
             added_density * (acceleration[k][1] + (grains.vy[g] + spin[1]) / dt)}};
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


  double CouplingState::volume(const std::size_t g) const
  {
    return dealii::numbers::PI * grains.fluid_radius[g] * grains.fluid_radius[g];
  }


  std::array<double, 2> CouplingState::reduced_weight(const std::size_t g) const
  {
    const double m = grains.mass[g] - fluid_density * volume(g);
    return {{m * gravity[0], m * gravity[1]}};
  }


  void TimeScheme::loads(const CouplingState                      &state,
                         const std::vector<std::array<double, 2>> &force,
                         grains::GrainLoads                       &loads) const
  {
    for (std::size_t g = 0; g < state.grains.n(); ++g)
      {
        const auto weight = state.reduced_weight(g);
        loads.fx[g]       = weight[0] + force[g][0];
        loads.fy[g]       = weight[1] + force[g][1];
        loads.drag[g]     = 0.;
      }
  }
} // namespace alluvium::coupling
