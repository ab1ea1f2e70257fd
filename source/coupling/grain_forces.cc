#include <alluvium/coupling/grain_forces.h>
#include <alluvium/coupling/piece_force.h>
#include <alluvium/coupling/rotation.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /** Columns of the sums; those of the time scheme and of the torques follow. */
    enum Column : unsigned int
    {
      force_x    = 0,
      velocity_x = 2,
      area       = 4,
      eps        = 5,
      reynolds   = 6,
      of_scheme  = 7
    };

    /** Of all pieces about the origin [N]. Collective. */
    double total_torque(const CouplingState &state, const fluid::FluidSpace<2> &space)
    {
      double     sum   = 0.;
      const auto shift = periodic_shifts(state, space);
      for (std::size_t k = 0; k < state.n_pieces(); ++k)
        {
          const unsigned int g    = state.map.grain()[k];
          const double       size = state.map.terms().shape[k].area;
          const auto         f    = piece_force(state.map, state, k).force;
          const auto        &arm  = state.map.arms()[k].arm;
          const auto        &c    = state.map.arms()[k].moments;
          const auto        &x    = state.map.terms().exchange[k];
          const double       b    = x.gamma * x.compliance;
          sum += size * ((state.grains.position[0][g] + arm[0] + shift[k][0]) * f[1] -
                         (state.grains.position[1][g] + arm[1] + shift[k][1]) * f[0]);
          sum +=
            (1. - b) * couple(state, k, state.latest_gradient[k]) - size * state.gamma[k] * x.omega * (c[0] + c[2]);
          if (x.reference)
            sum += b * couple(state, k, x.reference == 1 ? state.old_gradient[k] : state.before_latest_gradient[k]);
        }
      return dealii::Utilities::MPI::sum(sum, space.communicator());
    }
  } // namespace


  void GrainForces::collect(const CouplingState        &state,
                            const TimeScheme           &scheme,
                            const PieceDrag            &drag,
                            const fluid::FluidSpace<2> &space,
                            DragRangeRecord            &record,
                            grains::GrainLoads         &loads)
  {
    const std::size_t  n         = state.grains.n();
    const bool         with_spin = state.couples_spin();
    const unsigned int of_spin   = of_scheme + scheme.n_load_sums();
    GrainSums          sums(n, with_spin ? of_spin + n_torque_sums : of_spin);
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      {
        const PieceForce f    = piece_force(state.map, state, k);
        const double     size = state.map.terms().shape[k].area;
        double          *sum  = sums.of(state.map.grain()[k]);
        for (unsigned int d = 0; d < 2; ++d)
          {
            sum[force_x + d] += size * f.force[d];
            sum[velocity_x + d] += size * f.velocity[d];
          }
        sum[area] += size;
      }
    for (std::size_t g = 0; g < n; ++g)
      for (unsigned int i = 0; i < 2; ++i)
        sums.of(g)[eps + i] = drag.sums_of_conditions()[2 * g + i];
    scheme.add_load_sums(state, sums, of_scheme);
    if (with_spin)
      add_torque_sums(state, SeenFluid::latest, sums, of_spin);
    sums.complete(space.communicator());

    of_fluid.resize(n);
    seen_velocity.resize(n);
    record.resize(n);
    sums_of_grains        = {};
    const DragRange range = drag.law().range();
    for (std::size_t g = 0; g < n; ++g)
      {
        const double *sum = sums.of(g);
        for (unsigned int d = 0; d < 2; ++d)
          {
            of_fluid[g][d]      = sum[force_x + d];
            seen_velocity[g][d] = sum[velocity_x + d] / sum[area];
            sums_of_grains.force[d] += of_fluid[g][d];
          }
        const double size = std::hypot(of_fluid[g][0], of_fluid[g][1]);
        sums_of_grains.scale += size;
        if (!range.contains(sum[eps] / sum[area], sum[reynolds] / sum[area]))
          {
            record.note(g);
            sums_of_grains.outside_range += size;
          }
      }

    loads.reset(n);
    scheme.loads(state, of_fluid, sums, of_scheme, loads);
    if (!with_spin)
      return;
    loads.torque.resize(n);
    loads.spin_drag.resize(n);
    for (std::size_t g = 0; g < n; ++g)
      {
        loads.torque[g]    = sums.of(g)[of_spin];
        loads.spin_drag[g] = sums.of(g)[of_spin + 1];
      }
    sums_of_grains.torque = total_torque(state, space);
  }


  void GrainForces::clear()
  {
    of_fluid.clear();
    seen_velocity.clear();
  }
} // namespace alluvium::coupling
