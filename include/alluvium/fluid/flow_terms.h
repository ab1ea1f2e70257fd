#pragma once

#include <alluvium/fluid/vans_problem.h>

#include <algorithm>

namespace alluvium::fluid
{
  /**
   * How large the terms of the momentum equation are in a flow, whether they are solved for or not: root of the sum
   * over the nodes of |force|^2 over the node's volume, each [N/m^2]. Nodes at which the velocity is given do not
   * count.
   */
  struct FlowTerms
  {
    double inertia    = 0.; // eps rho du/dt
    double convection = 0.; // eps rho u.grad u
    double viscosity  = 0.; // div(eps eta (grad u + grad u^T))
    double pressure   = 0.; // eps grad p, p reduced: what drives, or holds, the fluid between grains

    /** What the others are small beside. */
    double largest() const { return std::max({inertia, convection, viscosity, pressure}); }
  };

  /**
   * Terms of @p solution of @p problem, of which fluid, void fraction and dt are used; @p before is the velocity at the
   * beginning of its step, @p volumes are those of the unknowns (LinearSolverScales). Fields ghosted. Collective.
   */
  template <int dim>
  FlowTerms flow_terms(const FluidSpace<dim>  &space,
                       const VansProblem<dim> &problem,
                       const BlockVector      &solution,
                       const BlockVector      &before,
                       const BlockVector      &volumes);
} // namespace alluvium::fluid
