#pragma once

#include <alluvium/fluid/cell_state.h>

namespace alluvium::fluid
{
  /** The terms integrated over the cell. */
  template <int dim, int n>
  void add_mesh(const CellState<dim, n> &state, LocalMatrix<dim, n> &L);

  /** Add the terms known from the mesh: u^n/dt, body force, mass source. */
  template <int dim, int n>
  void add_mesh_right_hand_side(const CellState<dim, n> &state, LocalVector<dim, n> &b);

  /** Sums over the rows of each equation of the squares of its largest terms: grad p and drive, and eps u.grad q. */
  template <int dim, int n>
  void term_squares(const CellState<dim, n> &state, const BlockVector &x, double &momentum, double &continuity);
} // namespace alluvium::fluid
