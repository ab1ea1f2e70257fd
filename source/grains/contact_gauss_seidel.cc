#include <alluvium/grains/contact_solver.h>
#include <alluvium/grains/contact_sweep.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::grains
{
  /**
   * Plain non-linear Gauss-Seidel (Jean & Moreau's NSCD iteration). Cheapest per sweep; a cold pile of n layers needs
   * some 2.7 n^2 sweeps, so it is for shallow or nearly settled scenes and for comparison.
   */
  class GaussSeidel : public ContactSolver
  {
  public:
    ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const override
    {
      ContactSolution solution;
      apply_impulses(problem);
      ContactMeasure measure(problem);
      while (solution.sweeps < tolerance.max_sweeps)
        {
          const SweepSums sums = sweep(problem, measure);
          ++solution.sweeps;
          // The changes of a sweep only hint at the residual after it, so measure before believing.
          if (measure.relative_change(sums) <= tolerance.allowance(solution.sweeps) * tolerance.residual)
            {
              measure_residual(measure, solution);
              if (solution.meets(tolerance))
                {
                  solution.converged = true;
                  return solution;
                }
            }
        }
      measure_residual(measure, solution);
      return solution;
    }
  };

  ALLUVIUM_REGISTER(
    ContactSolver,
    GaussSeidel,
    "Gauss-Seidel",
    "plain non-linear Gauss-Seidel sweeps: cheap per sweep, but a cold bed of n layers needs about 2.7 n^2 "
    "of them.")
} // namespace alluvium::grains
