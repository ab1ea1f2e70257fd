#pragma once

#include <alluvium/fluid/vans_problem.h>

#include <map>

namespace alluvium::fluid
{
  /**
   * Of what enters through each boundary with a given pressure, the share that is backflow: 0 where the flow only
   * enters, 1 where as much or more leaves. From u^n; of no use without convection, and then 0. Collective.
   */
  template <int dim>
  std::map<dealii::types::boundary_id, double> backflow_shares(const FluidSpace<dim>  &space,
                                                               const VansProblem<dim> &problem);

  /**
   * Mean of rho u_n^2/2 over what enters through each boundary with a given pressure [Pa], times the share that is no
   * backflow: what total pressures are above static ones. From @p field. Collective.
   */
  template <int dim>
  std::map<dealii::types::boundary_id, double>
  dynamic_pressures(const FluidSpace<dim> &space, const double density, const BlockVector &field);
} // namespace alluvium::fluid
