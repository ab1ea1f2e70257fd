#include <alluvium/grains/contact_measure.h>
#include <alluvium/grains/contact_relax.h>
#include <alluvium/grains/contact_solver.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  void apply_impulses(ContactProblem &problem)
  {
    for (const Contact &c : problem.contacts)
      push(problem, c, c.rn, c.rt);
    for (std::size_t k = 0; k < problem.rolling.size(); ++k)
      {
        RollingFriction &r = problem.rolling[k];
        roll(r, problem.discs[problem.contacts[k].i], problem.discs[problem.contacts[k].j], r.impulse);
        r.last = r.impulse;
      }
    if (problem.communicator != nullptr)
      problem.communicator->update_ghosts(problem.discs);
  }

  void refuse_ranks(const ContactProblem &problem, const std::string &solver)
  {
    check_user(problem.communicator == nullptr,
               "Contact solver: '" + solver +
                 "' runs on one rank only. Choose 'accelerated Gauss-Seidel', or run without mpirun.");
  }

  void measure_residual(const ContactMeasure &measure, ContactSolution &solution)
  {
    const ContactProblem &problem = measure.problem;
    ContactMeasure::Sums  sums    = measure.begin();
    double                largest[2];
    // A maximum needs no bound; if the sums outgrow theirs, once more with what the maxima allow.
    for (int attempt = 0; attempt < 2; ++attempt)
      {
        largest[0] = largest[1] = 0.;
        const auto add          = [&](const double change, const double size) {
          sums.change.add(change);
          sums.size.add(size);
          largest[0] = std::max(largest[0], change);
          largest[1] = std::max(largest[1], size);
        };
        for (const Contact &c : problem.contacts)
          if (problem.counts(c))
            {
              double rn, rt;
              CoulombLaw::solve(values(c), values(problem.discs[c.i]), values(problem.discs[c.j]), rn, rt);
              add((rn - c.rn) * (rn - c.rn) + (rt - c.rt) * (rt - c.rt), c.rn * c.rn + c.rt * c.rt);
            }
        for (std::size_t k = 0; k < problem.rolling.size(); ++k)
          if (const Contact &c = problem.contacts[k]; problem.counts(c))
            {
              const RollingFriction &r = problem.rolling[k];
              const double change = solve_rolling(r, c, problem.discs[c.i], problem.discs[c.j], r.impulse) - r.impulse;
              add(change * change, r.impulse * r.impulse);
            }
        if (problem.communicator != nullptr)
          {
            double all[2] = {sums.change.value(), sums.size.value()};
            problem.communicator->sum(all, 2);
            problem.communicator->max(largest, 2);
            sums.change.set(all[0]);
            sums.size.set(all[1]);
          }
        if (sums.change.holds() && sums.size.holds())
          break;
        const double n = measure.n_contacts();
        sums           = {ReproducibleSum(n * largest[0]), ReproducibleSum(n * largest[1]), ReproducibleSum(0.)};
      }
    const double n     = std::max(1., measure.n_contacts());
    const double scale = std::max(std::sqrt(sums.size.value() / n), problem.impulse_scale);
    solution.residual  = std::sqrt(sums.change.value() / n) / scale;
    solution.violation = std::sqrt(largest[0]) / scale;
  }

  bool is_solved(const ContactMeasure   &measure,
                 const SweepSums        &sums,
                 const ContactTolerance &tolerance,
                 ContactSolution        &solution,
                 const double            stride)
  {
    if (!(measure.relative_change(sums) <= stride * tolerance.allowance(solution.sweeps) * tolerance.residual))
      return false;
    measure_residual(measure, solution);
    solution.converged = solution.meets(tolerance);
    return solution.converged;
  }
} // namespace alluvium::grains
