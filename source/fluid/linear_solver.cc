#include <alluvium/fluid/linear_solver.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_vector.h>

#include <EpetraExt_MatrixMatrix.h>
#include <Epetra_CrsMatrix.h>

#include <sstream>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    constexpr double acceptable_residual = 1e-5;

    std::string in_digits(const double x)
    {
      std::ostringstream text;
      text << x;
      return text.str();
    }

    /** The matrix with its continuity rows scaled, so that one norm measures both equations fairly. */
    struct ScaledMatrix
    {
      const TrilinosWrappers::BlockSparseMatrix &matrix;
      double                                     scale;

      void vmult(BlockVector &dst, const BlockVector &src) const
      {
        matrix.vmult(dst, src);
        dst.block(1) *= scale;
      }
    };

    /** SIMPLE: u* = A^-1 r_u, p = S^-1 (r_p - C u*), u = u* - diag(A)^-1 B p, with ILU and a V-cycle as the inverses.
     */
    struct Simple
    {
      const TrilinosWrappers::BlockSparseMatrix &matrix;
      const TrilinosWrappers::PreconditionILU   &velocity;
      const TrilinosWrappers::PreconditionAMG   &pressure;
      const std::vector<double>                 &inverse_diagonal; // of -A
      double                                     scale;
      mutable BlockVector                        r;

      void vmult(BlockVector &dst, const BlockVector &src) const
      {
        velocity.vmult(dst.block(0), src.block(0));
        matrix.block(1, 0).vmult(r.block(1), dst.block(0));
        r.block(1).sadd(-1., 1. / scale, src.block(1));
        pressure.vmult(dst.block(1), r.block(1));
        matrix.block(0, 1).vmult(r.block(0), dst.block(1));
        for (unsigned int i = 0; i < inverse_diagonal.size(); ++i)
          dst.block(0).local_element(i) += inverse_diagonal[i] * r.block(0).local_element(i);
      }
    };
  } // namespace


  void LinearSolver::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Linear solver");
    prm.add_parameter(
      "Tolerance",
      tolerance,
      "Residual at which the fluid's linear solver stops, relative to the size of the terms of the equations "
      "(pressure gradient and volume flux).",
      Patterns::Double(1e-14, 0.1));
    prm.add_parameter(
      "Maximal iterations", max_iterations, "GMRES iterations after which a solve has failed.", Patterns::Integer(1));
    prm.add_parameter(
      "Rebuild threshold",
      rebuild_threshold,
      "The preconditioner is kept over time steps and rebuilt once a solve needs this many times the iterations "
      "that it needed when fresh.",
      Patterns::Double(1.));
    prm.leave_subsection();
  }


  void LinearSolver::clear()
  {
    exists = strong = false;
    velocity.clear();
    pressure.clear();
    schur.reset();
  }


  void LinearSolver::build(const TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    const auto &A = matrix.block(0, 0);
    velocity.initialize(A, TrilinosWrappers::PreconditionILU::AdditionalData(strong ? 2 : 0));

    negative_inverse_diagonal.clear();
    TrilinosWrappers::MPI::Vector inverse_diagonal(A.locally_owned_range_indices(), A.get_mpi_communicator());
    for (const auto i : A.locally_owned_range_indices())
      {
        negative_inverse_diagonal.push_back(-1. / A.diag_element(i));
        inverse_diagonal(i) = negative_inverse_diagonal.back();
      }
    inverse_diagonal.compress(VectorOperation::insert);
    TrilinosWrappers::SparseMatrix product;
    matrix.block(1, 0).mmult(product, matrix.block(0, 1), inverse_diagonal);
    // the union of both patterns: rows of prescribed pressures have no entry in C B
    Epetra_CrsMatrix *sum = nullptr;
    EpetraExt::MatrixMatrix::Add(
      matrix.block(1, 1).trilinos_matrix(), false, 1., product.trilinos_matrix(), false, 1., sum);
    schur.reset(sum);
    schur->FillComplete(matrix.block(1, 1).trilinos_matrix().DomainMap(),
                        matrix.block(1, 1).trilinos_matrix().RangeMap());

    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic              = true;
    data.higher_order_elements = false;
    data.smoother_sweeps       = 2;
    data.aggregation_threshold = 0.02;
    pressure.initialize(*schur, data);
    exists = true;
    fresh  = true;
  }


  LinearSolverReport LinearSolver::solve(const TrilinosWrappers::BlockSparseMatrix &matrix,
                                         const BlockVector                         &right_hand_side,
                                         const std::array<double, 2>               &scale,
                                         const AffineConstraints<double>           &constraints,
                                         BlockVector                               &x)
  {
    LinearSolverReport report;
    const double       ratio = scale[0] / scale[1];
    BlockVector        rhs(right_hand_side);
    rhs.block(1) *= ratio;
    const double norm = rhs.l2_norm(), target = tolerance * scale[0];
    AssertThrow(std::isfinite(norm), ExcMessage("The fluid's right-hand side is not finite."));
    x               = 0.;
    report.residual = norm / scale[0];
    if (norm <= target)
      return report;

    if (!exists)
      build(matrix);
    for (bool retry = true; retry;)
      {
        SolverControl                                     control(max_iterations, target, false, false);
        typename SolverGMRES<BlockVector>::AdditionalData data;
        data.max_n_tmp_vectors     = strong ? 150 : 60;
        data.right_preconditioning = true;
        SolverGMRES<BlockVector> gmres(control, data);
        const Simple             preconditioner{matrix, velocity, pressure, negative_inverse_diagonal, ratio, rhs};
        x     = 0.;
        retry = false;
        try
          {
            gmres.solve(ScaledMatrix{matrix, ratio}, x, rhs, preconditioner);
          }
        catch (const SolverControl::NoConvergence &)
          {
            // an old preconditioner gets a second chance as a fresh one, a fresh one as a stronger one
            if (!fresh || !strong)
              {
                strong = fresh;
                build(matrix);
                retry = true;
                continue;
              }
            // GMRES stalls where round-off of large cancelling terms is above the tolerance: good enough is told, not
            // hidden
            report.loose = true;
            AssertThrow(control.last_value() <= acceptable_residual * scale[0],
                        ExcMessage("The fluid's linear solver has not converged in " + std::to_string(max_iterations) +
                                   " iterations: relative residual " + in_digits(control.last_value() / scale[0]) +
                                   ", tolerance " + in_digits(tolerance) + "."));
          }
        report.n_iterations = control.last_step();
        report.residual     = control.last_value() / scale[0];
      }
    if (fresh)
      n_when_fresh = report.n_iterations;
    fresh = false;
    if (report.n_iterations > rebuild_threshold * n_when_fresh + 2)
      exists = false;
    constraints.set_zero(x);
    return report;
  }
} // namespace alluvium::fluid
