#pragma once

#include <alluvium/fluid/cell_state.h>

namespace alluvium::fluid
{
  /**
   * The terms of the pieces (intersections of grains and the cell): drag, the solid's share of the pressure gradient,
   * its velocity in the continuity equation. On parallelograms their moments are added up first.
   */
  template <int dim, int n>
  void add_pieces(const CellState<dim, n> &state, LocalMatrix<dim, n> &L);

  /** Add the terms that the pieces know: a, e and u_ref. */
  template <int dim, int n>
  void known_pieces(const CellState<dim, n> &state, LocalVector<dim, n> &r);
} // namespace alluvium::fluid
