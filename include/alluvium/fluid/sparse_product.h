#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Epetra_CrsMatrix.h>

#include <memory>

namespace alluvium::fluid
{
  /** C diag(d) B; @p diagonal has B's rows. Collective. */
  std::unique_ptr<Epetra_CrsMatrix> sparse_product(const dealii::TrilinosWrappers::SparseMatrix &C,
                                                   const Vector                                 &diagonal,
                                                   const dealii::TrilinosWrappers::SparseMatrix &B);

  /**
   * B^T diag(d) B; @p diagonal has B's rows. Collective. In place of deal.II's Tmmult(), which on several ranks writes
   * past the end of its result (Trilinos 13.2).
   */
  std::unique_ptr<Epetra_CrsMatrix> normal_product(const dealii::TrilinosWrappers::SparseMatrix &B,
                                                   const Vector                                 &diagonal);

  /** The sum of two matrices of the same rows, its pattern the union of theirs. Collective. */
  std::unique_ptr<Epetra_CrsMatrix> sparse_sum(const Epetra_CrsMatrix &a, const Epetra_CrsMatrix &b);
} // namespace alluvium::fluid
