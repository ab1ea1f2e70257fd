#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_precondition.h>

namespace alluvium::fluid
{
  /** What one solve cost. */
  struct LinearSolverReport
  {
    unsigned int n_iterations = 0;
    bool         loose        = false; // stopped above the tolerance, at an acceptable residual
    double       residual     = 0.;    // relative to the equations' terms
  };

  /**
   * GMRES with a SIMPLE preconditioner: ILU(0) on the velocity block, one algebraic multigrid V-cycle on
   * the Schur complement D - C diag(A)^-1 B. The preconditioner is kept over steps and rebuilt when it has become
   * clearly worse than when it was fresh. Where it fails (fast flow through fine cells in long steps) ILU(2) and a
   * longer memory of GMRES have a try.
   */
  class LinearSolver
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);

    /** Forget the preconditioner: the mesh or the time step changed. */
    void clear();

    /**
     * Solve matrix * x = right_hand_side until the residual is below the tolerance times @p scale, the norms of the two
     * equations' terms. Where GMRES stalls above it but below 1e-5, the report says `loose`; throws if it cannot do
     * that either.
     */
    LinearSolverReport solve(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix,
                             const BlockVector                                 &right_hand_side,
                             const std::array<double, 2>                       &scale,
                             const dealii::AffineConstraints<double>           &constraints,
                             BlockVector                                       &x);

    double       tolerance         = 1e-8;
    unsigned int max_iterations    = 300;
    double       rebuild_threshold = 1.7;

  private:
    void build(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix);

    bool                                      fresh = false, exists = false, strong = false;
    unsigned int                              n_when_fresh = 0;
    std::vector<double>                       negative_inverse_diagonal; // -1/diag(A), owned rows
    std::unique_ptr<Epetra_CrsMatrix>         schur;
    dealii::TrilinosWrappers::PreconditionILU velocity;
    dealii::TrilinosWrappers::PreconditionAMG pressure;
  };
} // namespace alluvium::fluid
