#pragma once

#include <alluvium/fluid/cell_state.h>

namespace alluvium::fluid
{
  /**
   * Drag around the centroid of piece @p k, so that it sees the fluid turn: gamma integral of (x - c).grad phi_i
   * (x - c).grad phi_j. Lumping would also hold back a turning fluid, as if the grain were as large as the cell:
   * that part of it, the projection on rotations of the cell's nodes, is taken out.
   */
  template <int dim, int n>
  void add_spin(const CellState<dim, n> &state, const unsigned int k, const double drag, LocalMatrix<dim, n> &L);

  /** What piece @p k knows of that: its spin, u_ref, and what of the fluid its spin displaces. */
  template <int dim, int n>
  void known_spin(const CellState<dim, n> &state, const unsigned int k, LocalVector<dim, n> &r);
} // namespace alluvium::fluid
