#pragma once

#include <alluvium/fluid/cell_state.h>

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

  /**
   * The terms of a face with a given pressure, in the rows of the momentum equation (doc/theory/open-boundaries.md):
   * traction without the transposed gradient, no streamline upwinding across the face, and where flow enters no
   * advection from outside, no tangential velocity, and for @p backflow (0 to 1) the loss of its kinetic energy. @p
   * state must be that of the face's cell. Adds to @p L and to the known terms @p b.
   */
  template <int dim, int n>
  void add_open_face(const CellState<dim, n> &state,
                     const OpenFace<dim>     &face,
                     const double             backflow,
                     LocalMatrix<dim, n>     &L,
                     LocalVector<dim, n>     &b);
} // namespace alluvium::fluid
