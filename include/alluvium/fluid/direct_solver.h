#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>

#include <memory>

namespace alluvium::fluid
{
  /**
   * LU factors of a copy of the block matrix as a single one, by a solver of Amesos: KLU, which works on one rank, or,
   * for many unknowns and where Trilinos has it, MUMPS. Needs in the order of 10 kB an unknown.
   */
  class DirectSolver
  {
  public:
    /** MUMPS is for more unknowns than @p many, where it begins to be faster. Collective. Ask is_singular() first. */
    explicit DirectSolver(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix,
                          const dealii::types::global_dof_index              many = 50000);
    ~DirectSolver();

    /** Has the factorisation failed, on any rank? */
    bool is_singular() const { return singular; }

    /** dst = A^-1 (src_0, src_1 / @p scale). Collective. */
    void vmult(BlockVector &dst, const BlockVector &src, const double scale) const;

  private:
    struct Factors;
    std::unique_ptr<Factors> factors;
    bool                     singular = false;
  };
} // namespace alluvium::fluid
