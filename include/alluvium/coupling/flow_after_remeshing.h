#pragma once

#include <alluvium/coupling/coupled_solve.h>

namespace alluvium::coupling
{
  /** How a flow that was carried over to another mesh changes in a time step, beside its size. */
  struct FlowChange
  {
    double speed        = 0.; // largest velocity of the fluid [m/s]
    double acceleration = 0.; // largest change of it in the last step [m/s]
    double grains       = 0.; // largest velocity of a grain [m/s]

    /** Does it hardly change in a step, through grains that hardly move? */
    bool is_slow() const { return std::max(acceleration, grains) <= 1e-2 * speed; }
  };

  /** The fields carried over are those of @p solver, and @p before a step before [m/s, Pa]. Collective. */
  FlowChange flow_change(const fluid::FluidSpace<2> &space,
                         const fluid::VansSolver<2> &solver,
                         const fluid::BlockVector   &before,
                         const grains::GrainArrays  &grains);

  /**
   * Find the flow that has on the new mesh the acceleration that it had, (solution - @p before)/@p dt, and so the same
   * forces on the grains, which move with their velocities. Boundary conditions are at the present time. Where the flow
   * is not slow it has only as long for it as drag takes to bring grains and fluid together, and only its velocity is
   * kept, which fulfils the continuity equation of this mesh; the pressure stays as it was carried over. @p frozen is
   * the scheme for grains whose velocity is known. Collective.
   */
  SolveCounts find_flow_after_remeshing(CoupledSolve                       &coupled,
                                        fluid::VansSolver<2>               &solver,
                                        const fluid::BoundaryConditions<2> &boundary_conditions,
                                        const TimeScheme                   &frozen,
                                        const FlowChange                   &change,
                                        const fluid::BlockVector           &before,
                                        double                              dt,
                                        CouplingState                      &state,
                                        MPI_Comm                            communicator);
} // namespace alluvium::coupling
