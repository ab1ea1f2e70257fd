#pragma once

#include <alluvium/fluid/vans_problem.h>

namespace alluvium::fluid
{
  /**
   * Where the fluid's kinetic energy came from and went in a time step, as powers per unit depth [W/m]: the discrete
   * momentum equation times u^{n+1} plus the continuity equation times p^{n+1}, sorted. p is the reduced pressure, so
   * that gravity acts on the grains' submerged weight only.
   *   (K^{n+1} - K^n)/dt = boundaries + body - to_grains - drag - viscous - stabilisation - time - open + unexplained
   * where `unexplained` is what the convective form makes where the discrete continuity equation holds in the mean of
   * cells only, where the void fraction between nodes is not that of the pieces, and where it changes from step to
   * step.
   */
  struct EnergyBalance
  {
    double kinetic_energy = 0.; // K^{n+1} with the void fraction of this step [J/m]
    double kinetic_before = 0.; // of u^n, with the same void fraction [J/m]
    double boundaries    = 0.; // work of the given pressures and velocities, and the kinetic energy carried in less out
    double body          = 0.; // of the body force
    double to_grains     = 0.; // work of the fluid's force on the solid
    double drag          = 0.; // dissipated by the slip
    double viscous       = 0.; // dissipated by shear
    double stabilisation = 0.; // taken by PSPG, SUPG, lumping of the drag
    double time          = 0.; // taken by the backward Euler method
    double open          = 0.; // taken by the terms of boundaries

    /** Powers that give less those that take [W/m]. */
    double explained() const { return boundaries + body - to_grains - drag - viscous - stabilisation - time - open; }

    /** Of the largest magnitude among them. */
    double largest() const;
  };

  /** Of a solved problem; collective. Costs about as much as an assembly. */
  template <int dim>
  EnergyBalance
  energy_balance(const FluidSpace<dim> &space, const VansProblem<dim> &problem, const BlockVector &solution);
} // namespace alluvium::fluid
