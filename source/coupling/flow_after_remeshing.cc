#include <alluvium/coupling/flow_after_remeshing.h>
#include <alluvium/fluid/largest_speed.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace alluvium::coupling
{
  using namespace dealii;

  namespace
  {
    /** Mass of all grains over their drag: how fast it brings grains and fluid together [s]. */
    double relaxation_time(const CouplingState &state, const MPI_Comm communicator)
    {
      double drag = 0., mass = 0.;
      for (std::size_t k = 0; k < state.n_pieces(); ++k)
        drag += state.map.terms().shape[k].area * state.gamma[k];
      for (const double m : state.grains.mass)
        mass += std::isinf(m) ? 0. : m;
      drag = Utilities::MPI::sum(drag, communicator);
      return drag > 0. ? mass / drag : 0.;
    }
  } // namespace


  FlowChange flow_change(const fluid::FluidSpace<2> &space,
                         const fluid::VansSolver<2> &solver,
                         const fluid::BlockVector   &before,
                         const grains::GrainArrays  &grains)
  {
    fluid::BlockVector change = solver.old();
    change.zero_out_ghost_values();
    change.add(-1., before);
    FlowChange result;
    for (std::size_t g = 0; g < grains.n(); ++g)
      result.grains = std::max(result.grains, std::hypot(grains.velocity[0][g], grains.velocity[1][g]));
    result.speed        = fluid::largest_speed(space, solver.old().block(0));
    result.acceleration = fluid::largest_speed(space, change.block(0));
    return result;
  }


  SolveCounts find_flow_after_remeshing(CoupledSolve                       &coupled,
                                        fluid::VansSolver<2>               &solver,
                                        const fluid::BoundaryConditions<2> &boundary_conditions,
                                        const TimeScheme                   &frozen,
                                        const FlowChange                   &change,
                                        const fluid::BlockVector           &before,
                                        const double                        dt,
                                        CouplingState                      &state,
                                        MPI_Comm                            communicator)
  {
    // slow: a step so long that only the acceleration that is given is left; else so long that the slip finds its own
    constexpr double longest = 1e3, n_relaxations = 3.;
    double           factor =
      change.is_slow() ? longest : std::clamp(n_relaxations * relaxation_time(state, communicator) / dt, 1., longest);
    // but no longer than the flow needs to become another one: what is not balanced would carry it anywhere
    if (factor * change.acceleration > change.speed)
      factor = std::max(1., change.speed / change.acceleration);
    state.dt = factor * dt;
    coupled.find_acceleration(state);
    fluid::BlockVector inertia = solver.old();
    inertia.zero_out_ghost_values();
    inertia.sadd(1. - factor, factor, before);
    inertia.update_ghost_values();
    fluid::VansProblem<2> problem{};
    problem.dt               = factor * dt;
    problem.inertia          = &inertia;
    problem.stabilisation_dt = dt;
    problem.tolerance_factor = 1. / factor; // what the solver leaves is an acceleration, too: that of a step of dt
    const SolveCounts counts = coupled.solve(boundary_conditions, frozen, problem, state);
    if (!change.is_slow())
      {
        // the pressure that did away with what interpolation left is not that of the flow
        fluid::BlockVector field = solver.solution();
        field.block(1)           = solver.old().block(1);
        solver.set_solution(field);
      }
    return counts;
  }
} // namespace alluvium::coupling
