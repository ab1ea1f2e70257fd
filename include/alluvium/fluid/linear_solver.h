#pragma once

#include <alluvium/fluid/direct_solver.h>
#include <alluvium/utilities/checked_file.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_precondition.h>

namespace alluvium::fluid
{
  /** What one solve cost. */
  struct LinearSolverReport
  {
    unsigned int n_iterations = 0;
    bool         loose        = false; // stopped above the tolerance, at an acceptable residual
    bool         direct       = false; // with the factors of a direct solver, after all else had failed
    double       residual     = 0.;    // relative to the equations' terms
  };

  /** What the preconditioner wants to know of the equations besides their matrix. */
  struct LinearSolverScales
  {
    double      inertia   = 0.; // density over time step [kg/(m^3 s)]
    double      viscosity = 0.; // [Pa s]
    BlockVector volumes;        // around each unknown's node [m^dim]
  };

  /**
   * GMRES with a block preconditioner from the factorisation
   *   u* = A^-1 r_u,   p = S^-1 (r_p - C u*),   u = u* - A^-1 B p.
   * A^-1 is ILU(0), or first an algebraic multigrid V-cycle where diffusion outweighs inertia and drag by far. S^-1 is
   * one V-cycle, smoothed with ILU(0), on D - C M^-1 B, plus viscosity over volume on the diagonal (Cahouet and
   * Chabard, Int. J. Numer. Methods Fluids 8, 1988); M are the row sums of A: inertia and drag, in which diffusion
   * cancels. The preconditioner is kept over steps and rebuilt when it has become clearly worse than when it was fresh.
   *
   * Where that fails, convection is strong: fast flow through fine cells in long steps. Then C is the problem, in which
   * the stabilisation has a share of the whole momentum equation; it cancels against D as long as A^-1 stands beside
   * it, but not with M^-1 in its place. So P = D + B^T M^-1 B, where M are sums of the rows' absolute values, and S^-1
   * = P^-1 (D + B^T M^-1 A M^-1 B) P^-1, the least-squares commutator (Elman et al., SIAM J. Sci. Comput. 27, 2006; 30,
   * 2007 for stabilised elements).
   *
   * Where that fails, too, the last resort are LU factors of the whole matrix, kept and rebuilt like any other
   * preconditioner, until the others have a try again after some tens of solves.
   */
  class LinearSolver
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);

    /** Forget the preconditioner: the mesh or the time step changed. */
    void clear();

    /** This rank's part of the matrix that the preconditioner was built from, and what decides when it is rebuilt. */
    void save(ByteWriter &writer) const;

    /**
     * Build the preconditioner that was saved, through @p matrix, which has the same pattern; with another one there is
     * none afterwards. Throws std::runtime_error if @p reader ends. Collective.
     */
    void load(ByteReader &reader, dealii::TrilinosWrappers::BlockSparseMatrix &matrix);

    /**
     * Solve matrix * x = right_hand_side until the residual is below the tolerance times @p scale, the norms of the two
     * equations' terms, and times @p tolerance_factor, as far as round-off allows. Where GMRES stalls above it but
     * below 1e-5, the report says `loose`; throws if neither it nor a direct solver can do that. Collective.
     */
    LinearSolverReport solve(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix,
                             const BlockVector                                 &right_hand_side,
                             const std::array<double, 2>                       &scale,
                             const dealii::AffineConstraints<double>           &constraints,
                             const double                                       tolerance_factor,
                             BlockVector                                       &x);

    double       tolerance         = 1e-8;
    unsigned int max_iterations    = 300;
    double       rebuild_threshold = 1.7;
    unsigned int direct_up_to      = 200000; // unknowns

    /** To be filled before the first solve. */
    LinearSolverScales scales;

  private:
    struct RowSums;
    void build(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix, const RowSums &row_sums);
    /** There is a preconditioner of this matrix: remember that. */
    void built(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix);
    /** Solve from x = 0 with the present preconditioner; does its residual say that it has converged? */
    bool gmres(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix,
               const RowSums                                     &row_sums,
               const double                                       scale,
               const BlockVector                                 &rhs,
               dealii::SolverControl                             &control,
               BlockVector                                       &x) const;
    /** Make LU factors to go on with; else say why that cannot be. */
    std::string factorise(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix);

    bool                                      fresh = false, exists = false, diffusive = false, convective = false;
    unsigned int                              n_when_fresh = 0, n_direct_solves = 0;
    std::vector<double>                       built_from;                             // all values of the matrix
    double                                    inertia_then = 0., viscosity_then = 0.; // the scales of then
    bool                                      use_direct = false; // also before its factors are there
    std::unique_ptr<DirectSolver>             direct;
    Vector                                    inverse_mass;
    std::vector<double>                       mobility; // viscosity over volume, owned pressures [Pa s/m^dim]
    std::unique_ptr<Epetra_CrsMatrix>         schur;
    dealii::TrilinosWrappers::PreconditionILU velocity;
    dealii::TrilinosWrappers::PreconditionAMG coarse_velocity, pressure;
  };
} // namespace alluvium::fluid
