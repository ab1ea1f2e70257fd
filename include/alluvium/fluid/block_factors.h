#pragma once

#include <alluvium/fluid/direct_solver.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_precondition.h>

namespace alluvium::fluid
{
  /** The matrix with its continuity rows scaled, so that one norm measures both equations fairly. */
  struct ScaledMatrix
  {
    const dealii::TrilinosWrappers::BlockSparseMatrix &matrix;
    double                                             scale;

    void vmult(BlockVector &dst, const BlockVector &src) const
    {
      matrix.vmult(dst, src);
      dst.block(1) *= scale;
    }
  };

  /** A^-1 of the scaled matrix from LU factors of one like it. */
  struct ScaledFactors
  {
    const DirectSolver &factors;
    double              scale;

    void vmult(BlockVector &dst, const BlockVector &src) const { factors.vmult(dst, src, scale); }
  };

  /** The factors of LinearSolver's preconditioner, applied one after the other. */
  struct BlockFactors
  {
    const dealii::TrilinosWrappers::BlockSparseMatrix &matrix;
    const dealii::TrilinosWrappers::PreconditionBase  &first_velocity, &last_velocity;
    const dealii::TrilinosWrappers::PreconditionAMG   &pressure;
    const std::vector<double>                         &mobility;
    const std::vector<double>                         *row_sums;     // for the last velocity; none: last_velocity it is
    const Vector                                      *inverse_mass; // where convection is strong
    double                                             scale;
    mutable BlockVector                                r, s;

    void vmult(BlockVector &dst, const BlockVector &src) const
    {
      first_velocity.vmult(dst.block(0), src.block(0));
      matrix.block(1, 0).vmult(r.block(1), dst.block(0));
      r.block(1).sadd(-1., 1. / scale, src.block(1));
      pressure.vmult(dst.block(1), r.block(1));
      if (inverse_mass)
        commute(dst.block(1));
      for (unsigned int i = 0; i < mobility.size(); ++i)
        dst.block(1).local_element(i) += mobility[i] * r.block(1).local_element(i);
      matrix.block(0, 1).vmult(r.block(0), dst.block(1));
      if (!row_sums)
        {
          last_velocity.vmult(s.block(0), r.block(0));
          dst.block(0) -= s.block(0);
        }
      else // with which p is the solution of the continuity equation
        for (unsigned int i = 0; i < row_sums->size(); ++i)
          dst.block(0).local_element(i) -= r.block(0).local_element(i) / (*row_sums)[i];
    }

    /** p becomes P^-1 (D + B^T M^-1 A M^-1 B) p. */
    void commute(Vector &p) const
    {
      matrix.block(0, 1).vmult(r.block(0), p);
      r.block(0).scale(*inverse_mass);
      matrix.block(0, 0).vmult(s.block(0), r.block(0));
      s.block(0).scale(*inverse_mass);
      matrix.block(0, 1).Tvmult(r.block(1), s.block(0));
      matrix.block(1, 1).vmult(s.block(1), p);
      s.block(1) += r.block(1);
      pressure.vmult(p, s.block(1));
    }
  };
} // namespace alluvium::fluid
