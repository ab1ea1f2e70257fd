#pragma once

#include <alluvium/coupling/declarations.h>

#include <array>

namespace alluvium::grains
{
  struct GrainArrays;
}

namespace alluvium::coupling
{
  /** What a change of the mesh might spoil; sums over all ranks. */
  struct FlowTotals
  {
    double                solid_volume  = 0.;         // integral of 1 - eps [m^2]
    std::array<double, 2> momentum      = {{0., 0.}}; // integral of rho eps u [kg/s]
    double                mass_residual = 0.;         // see below [-]
  };

  /**
   * The totals of the fluid's present solution. The mass residual is that of continuity (1) without its stabilisation,
   * the integral of (eps u + (1 - eps) v).grad q for the basis functions q of all nodes inside the domain (l2 norm),
   * over the L2 norm of eps u: zero if no node gains or loses volume; what the stabilisation moves remains. v is the
   * velocity of the grains' centres. The void fraction must be that of @p grains as they are. Collective.
   */
  FlowTotals flow_totals(const Coupling                     &coupling,
                         const fluid::FluidSpace<2>         &space,
                         const fluid::VansSolver<2>         &solver,
                         const fluid::BoundaryConditions<2> &boundary_conditions,
                         const grains::GrainArrays          &grains);
} // namespace alluvium::coupling
