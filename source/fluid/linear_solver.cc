#include <alluvium/fluid/block_factors.h>
#include <alluvium/fluid/linear_solver.h>
#include <alluvium/fluid/sparse_product.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/divergence.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/solver_gmres.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Vector.h>

#include <numeric>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    constexpr int    dim                 = 2;
    constexpr double acceptable_residual = 1e-5, smallest_tolerance = 1e-12;
    // of a diagonal entry of the velocity block over its row sum, above which ILU(0) needs too many iterations
    constexpr double diffusive_ratio = 20.;
    // fresh, the cheap preconditioner needs about ten iterations or fails
    constexpr unsigned int cheap_iterations = 60;
    // with LU factors: one or two when fresh; and for so many solves they are used before the others have a try again
    constexpr unsigned int direct_iterations = 20, direct_solves = 50;
    // and below which the row sums are as good an inverse for the last correction of the velocity
    constexpr double lumping_ratio = 4.;

    double residual_norm(const ScaledMatrix &matrix, const BlockVector &x, const BlockVector &rhs)
    {
      BlockVector residual;
      residual.reinit(rhs, true);
      matrix.vmult(residual, x);
      residual.sadd(-1., 1., rhs);
      return residual.l2_norm();
    }

    /** Whether all of @p x are numbers. Its norm would say so too, but deal.II's debug library aborts in it.
     * Collective. */
    bool is_finite(const BlockVector &x)
    {
      unsigned int n_not_finite = 0;
      for (unsigned int b = 0; b < x.n_blocks(); ++b)
        for (const double value : x.block(b))
          n_not_finite += !std::isfinite(value);
      return Utilities::MPI::sum(n_not_finite, x.block(0).get_mpi_communicator()) == 0;
    }

    /** What rounding the terms of a row leaves of a residual: no solver can do better. */
    double round_off(const TrilinosWrappers::BlockSparseMatrix &matrix, const double scale, const BlockVector &x)
    {
      double sum = 0.;
      for (unsigned int a = 0; a < 2; ++a)
        for (unsigned int b = 0; b < 2; ++b)
          sum += (a == 1 ? scale : 1.) * matrix.block(a, b).linfty_norm() * x.block(b).l2_norm();
      return 4. * std::numeric_limits<double>::epsilon() * sum;
    }

    /** Call @p action(values, their number) for each block of @p matrix; they are one after the other in memory. */
    template <typename Action>
    void for_each_block(const TrilinosWrappers::BlockSparseMatrix &matrix, const Action &action)
    {
      for (unsigned int a = 0; a < 2; ++a)
        for (unsigned int b = 0; b < 2; ++b)
          {
            const Epetra_CrsMatrix &rows  = matrix.block(a, b).trilinos_matrix();
            int                    *begin = nullptr, *column = nullptr;
            double                 *value = nullptr;
            if (rows.NumMyNonzeros() == 0)
              continue;
            AssertThrow(rows.ExtractCrsDataPointers(begin, column, value) == 0, ExcInternalError());
            action(value, rows.NumMyNonzeros());
          }
    }

    std::vector<double> values_of(const TrilinosWrappers::BlockSparseMatrix &matrix)
    {
      std::vector<double> all;
      for_each_block(matrix, [&](const double *value, const int n) { all.insert(all.end(), value, value + n); });
      return all;
    }

    void set_values(const std::vector<double> &all, TrilinosWrappers::BlockSparseMatrix &matrix)
    {
      auto next = all.begin();
      for_each_block(matrix, [&](double *value, const int n) {
        std::copy(next, next + n, value);
        next += n;
      });
    }

    /** Sums of the absolute values of the owned rows. */
    std::vector<double> absolute_row_sums(const Epetra_CrsMatrix &rows)
    {
      std::vector<double> sums(rows.NumMyRows());
      for (int i = 0; i < rows.NumMyRows(); ++i)
        {
          int     n     = 0;
          double *value = nullptr;
          rows.ExtractMyRowView(i, n, value);
          sums[i] =
            std::accumulate(value, value + n, 0., [](const double s, const double x) { return s + std::abs(x); });
        }
      return sums;
    }
  } // namespace


  /** Inertia and drag of the owned velocities, and how far diffusion outweighs them. */
  struct LinearSolver::RowSums
  {
    std::vector<double> sum;
    double              largest_ratio = 0.; // of a diagonal entry over its row sum, on any rank

    RowSums(const TrilinosWrappers::SparseMatrix &matrix, const LinearSolverScales &scales)
    {
      const Epetra_CrsMatrix &rows = matrix.trilinos_matrix();
      Epetra_Vector           diagonal(rows.RowMap());
      rows.ExtractDiagonalCopy(diagonal);
      for (int i = 0; i < rows.NumMyRows(); ++i)
        {
          // convection can turn the sign of those next to walls, whose columns are missing
          const double volume = scales.volumes.block(0).local_element(i);
          int          n      = 0;
          double      *value  = nullptr;
          rows.ExtractMyRowView(i, n, value);
          sum.push_back(std::max(std::accumulate(value, value + n, 0.), 0.1 * scales.inertia * volume));
          largest_ratio = std::max(largest_ratio, diagonal[i] / sum[i]);
        }
      largest_ratio = Utilities::MPI::max(largest_ratio, matrix.get_mpi_communicator());
    }
  };


  void LinearSolver::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Linear solver");
    prm.add_parameter(
      "Tolerance",
      tolerance,
      "Residual at which the fluid's linear solver stops, relative to the size of the terms of the equations "
      "(pressure gradient and volume flux).",
      Patterns::Double(1e-14, 0.1));
    prm.add_parameter("Maximal iterations",
                      max_iterations,
                      "GMRES iterations after which a solve with the preconditioner for strong convection has failed.",
                      Patterns::Integer(1));
    prm.add_parameter("Direct solver up to",
                      direct_up_to,
                      "Where GMRES fails, a direct solver is the last resort, if the fluid has no more unknowns than "
                      "this [-]: it takes long, and in the order of 10 kB an unknown. 0: never.",
                      Patterns::Integer(0));
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
    exists     = false;
    convective = false;
    direct.reset();
    use_direct      = false;
    n_direct_solves = 0;
    velocity.clear();
    coarse_velocity.clear();
    pressure.clear();
    schur.reset();
    built_from.clear();
  }


  void LinearSolver::save(ByteWriter &writer) const
  {
    writer.put<std::uint8_t>(exists);
    writer.put<std::uint8_t>(convective);
    writer.put<std::uint8_t>(use_direct);
    writer.put(n_direct_solves);
    writer.put(n_when_fresh);
    writer.put(inertia_then);
    writer.put(viscosity_then);
    writer.put(exists ? built_from : std::vector<double>());
  }


  void LinearSolver::load(ByteReader &reader, TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    clear();
    const bool existed             = reader.get<std::uint8_t>() != 0;
    convective                     = reader.get<std::uint8_t>() != 0;
    use_direct                     = reader.get<std::uint8_t>() != 0;
    n_direct_solves                = reader.get<unsigned int>();
    n_when_fresh                   = reader.get<unsigned int>();
    scales.inertia                 = reader.get<double>();
    scales.viscosity               = reader.get<double>();
    const std::vector<double> then = reader.get_vector<double>();
    if (Utilities::MPI::min(int(existed && then.size() == values_of(matrix).size()), matrix.get_mpi_communicator()) ==
        0)
      return;
    set_values(then, matrix);
    build(matrix, RowSums(matrix.block(0, 0), scales));
    fresh = false;
  }


  void LinearSolver::build(const TrilinosWrappers::BlockSparseMatrix &matrix, const RowSums &row_sums)
  {
    if (use_direct)
      {
        const std::string why_not = factorise(matrix);
        AssertThrow(why_not.empty(), ExcMessage("The fluid's linear solver has failed. " + why_not));
        return;
      }
    const auto             &A    = matrix.block(0, 0);
    const Epetra_CrsMatrix &rows = A.trilinos_matrix();
    pressure.clear(); // while the matrix that its smoothers look at is still there
    velocity.initialize(A, TrilinosWrappers::PreconditionILU::AdditionalData(0));

    const std::vector<double> mass = convective ? absolute_row_sums(rows) : row_sums.sum;
    inverse_mass.reinit(scales.volumes.block(0), true);
    for (int i = 0; i < rows.NumMyRows(); ++i)
      inverse_mass.local_element(i) = 1. / mass[i];
    diffusive = !convective && row_sums.largest_ratio > diffusive_ratio;
    if (diffusive)
      {
        TrilinosWrappers::PreconditionAMG::AdditionalData data;
        data.elliptic              = true;
        data.higher_order_elements = false;
        data.smoother_type         = "symmetric Gauss-Seidel";
        data.smoother_sweeps       = 1;
        data.aggregation_threshold = 0.02;
        data.constant_modes.assign(dim, std::vector<bool>(rows.NumMyRows(), false));
        for (int i = 0; i < rows.NumMyRows(); ++i)
          data.constant_modes[i % dim][i] = true; // components are interleaved
        coarse_velocity.initialize(A, data);
      }

    mobility.clear();
    for (unsigned int i = 0; i < scales.volumes.block(1).locally_owned_size(); ++i)
      mobility.push_back(convective ? 0. : scales.viscosity / scales.volumes.block(1).local_element(i));
    Vector sign(inverse_mass);
    if (!convective)
      sign *= -1.;
    // the union of both patterns: rows of prescribed pressures have no entry in C B
    schur = sparse_sum(matrix.block(1, 1).trilinos_matrix(),
                       convective ? *normal_product(matrix.block(0, 1), sign)
                                  : *sparse_product(matrix.block(1, 0), sign, matrix.block(0, 1)));

    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic              = true;
    data.higher_order_elements = false;
    data.aggregation_threshold = 0.02;
    data.smoother_type         = convective ? "Chebyshev" : "ILU";
    data.smoother_sweeps       = convective ? 2 : 1;
    data.smoother_overlap = !convective; // as many iterations on two ranks as on one; on the velocity it would do harm
    pressure.initialize(*schur, data);
    built(matrix);
  }


  void LinearSolver::built(const TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    exists = fresh = true;
    built_from     = values_of(matrix);
    inertia_then   = scales.inertia;
    viscosity_then = scales.viscosity;
  }


  std::string LinearSolver::factorise(const TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    if (matrix.m() > direct_up_to)
      return "The direct solver has not been tried: the fluid has " + std::to_string(matrix.m()) +
             " unknowns, more than 'Fluid/Linear solver/Direct solver up to' = " + std::to_string(direct_up_to) + ".";
    direct.reset(); // there is memory for one
    use_direct = false;
    direct     = std::make_unique<DirectSolver>(matrix);
    if (direct->is_singular())
      {
        direct.reset();
        exists = false;
        return "A direct solver has failed, too: the equations are singular.";
      }
    use_direct = true;
    built(matrix);
    return "";
  }


  bool LinearSolver::gmres(const TrilinosWrappers::BlockSparseMatrix &matrix,
                           const RowSums                             &row_sums,
                           const double                               scale,
                           const BlockVector                         &rhs,
                           SolverControl                             &control,
                           BlockVector                               &x) const
  {
    typename SolverGMRES<BlockVector>::AdditionalData data;
    data.max_n_tmp_vectors     = convective ? 100 : 60;
    data.right_preconditioning = true;
    SolverGMRES<BlockVector>                  solver(control, data);
    const TrilinosWrappers::PreconditionBase &first =
      diffusive ? static_cast<const TrilinosWrappers::PreconditionBase &>(coarse_velocity) : velocity;
    const bool         lumped = !convective && row_sums.largest_ratio < lumping_ratio;
    const BlockFactors preconditioner{matrix,
                                      first,
                                      velocity,
                                      pressure,
                                      mobility,
                                      lumped ? &row_sums.sum : nullptr,
                                      convective ? &inverse_mass : nullptr,
                                      scale,
                                      rhs,
                                      rhs};
    x = 0.;
    try
      {
        if (use_direct)
          solver.solve(ScaledMatrix{matrix, scale}, x, rhs, ScaledFactors{*direct, scale});
        else
          solver.solve(ScaledMatrix{matrix, scale}, x, rhs, preconditioner);
      }
    catch (const SolverControl::NoConvergence &)
      {
        return false;
      }
    return true;
  }


  LinearSolverReport LinearSolver::solve(const TrilinosWrappers::BlockSparseMatrix &matrix,
                                         const BlockVector                         &right_hand_side,
                                         const std::array<double, 2>               &scale,
                                         const AffineConstraints<double>           &constraints,
                                         const double                               tolerance_factor,
                                         BlockVector                               &x)
  {
    Assert(scales.volumes.size() == matrix.m(), ExcMessage("The scales are filled before the first solve."));
    Assert(right_hand_side.size() == matrix.m() && x.size() == matrix.m(),
           ExcDimensionMismatch(right_hand_side.size(), matrix.m()));
    Assert(scale[0] > 0. && scale[1] > 0., ExcMessage("Nothing is small beside terms of no size."));
    LinearSolverReport report;
    const double       ratio = scale[0] / scale[1];
    BlockVector        rhs(right_hand_side);
    rhs.block(1) *= ratio;
    const double stop = std::max(tolerance * tolerance_factor, std::min(tolerance, smallest_tolerance));
    const double norm = is_finite(rhs) ? rhs.l2_norm() : std::numeric_limits<double>::infinity();
    if (!std::isfinite(norm)) // squares can overflow, too
      throw Divergence("The fluid's right-hand side is not finite.");
    const double target = stop * scale[0];
    x                   = 0.;
    report.residual     = norm / scale[0];
    if (norm <= target)
      return report;

    const RowSums row_sums(matrix.block(0, 0), scales);
    if (use_direct && n_direct_solves == direct_solves)
      {
        direct.reset();
        use_direct      = false;
        exists          = false;
        n_direct_solves = 0;
      }
    if (!exists)
      build(matrix, row_sums);
    for (bool solved = false; !solved;)
      {
        const unsigned int limit =
          use_direct ? direct_iterations : std::min(max_iterations, convective ? max_iterations : cheap_iterations);
        SolverControl control(limit, target, false, false);
        bool          converged = gmres(matrix, row_sums, ratio, rhs, control, x);
        // GMRES only estimates its residual: of a singular preconditioner nothing is left of it
        const double found      = residual_norm(ScaledMatrix{matrix, ratio}, x, rhs);
        const double acceptable = acceptable_residual * scale[0];
        converged               = converged && found <= std::max(acceptable, 2. * target);
        report.n_iterations     = control.last_step();
        report.residual         = (converged ? control.last_value() : found) / scale[0];
        solved                  = converged;
        if (!converged && (!fresh || !convective))
          {
            // an old preconditioner gets a second chance as a fresh one, a fresh one as that for strong convection
            convective = convective || fresh;
            build(matrix, row_sums);
          }
        else if (!converged && found <= std::min(round_off(matrix, ratio, x), 1e-3 * scale[0]))
          // it stalls where round-off of large cancelling terms is above the tolerance: good enough is told, not hidden
          solved = report.loose = true;
        else if (!converged)
          {
            const std::string why_not = use_direct
                                          ? "These were with the factors of a direct solver: the equations are "
                                            "singular, or nearly so. Are Fluid/Viscosity, Fluid/Density and lengths "
                                            "in SI units, and is the time step sensible?"
                                          : factorise(matrix);
            // what GMRES has left may grow over the steps: good enough only where nothing does better
            solved = report.loose = !why_not.empty() && found <= acceptable;
            AssertThrow(why_not.empty() || solved,
                        ExcMessage("The fluid's linear solver has not converged in " + std::to_string(limit) +
                                   " iterations: relative residual " + in_digits(report.residual) + ", tolerance " +
                                   in_digits(stop) + ". " + why_not));
          }
      }
    report.direct = use_direct;
    n_direct_solves += report.direct;
    if (fresh)
      n_when_fresh = report.n_iterations;
    fresh = false;
    if (report.n_iterations > rebuild_threshold * n_when_fresh + 2)
      exists = false;
    constraints.set_zero(x);
    return report;
  }
} // namespace alluvium::fluid
