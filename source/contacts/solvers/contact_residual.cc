#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_pack.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/moment_correction.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    /** What the natural map changes in a pass over all contacts: squares, of which terms are rounded with a shift. */
    struct ResidualTerms
    {
      double shift  = 0.; // see ReproducibleSum
      double change = 0., largest = 0.;
    };

    /** One contact, or several, of which those with @p weight 1 count and those with 0 do not. */
    template <typename T>
    ALLUVIUM_INLINE void add_residual(const ContactValues<T> &c,
                                      const DiscValues<T>    &i,
                                      const DiscValues<T>    &j,
                                      const T                &weight,
                                      const double            shift,
                                      T                      &change,
                                      T                      &largest)
    {
      T rn, rt;
      FrictionCone::solve(c, i, j, rn, rt);
      const T changed = weight * ((rn - c.rn) * (rn - c.rn) + (rt - c.rt) * (rt - c.rt));
      change += (changed + shift) - shift;
      raise_to(largest, changed);
    }

    template <bool packed>
    ALLUVIUM_INLINE void add_residuals(const ContactProblem &problem, ResidualTerms &terms)
    {
      const Contact *const contacts = problem.contacts.data();
      const Disc *const    discs    = problem.discs.data();
      const std::size_t    n        = problem.contacts.size();
      std::size_t          k        = 0;
      if constexpr (packed)
        {
          Pack                change{}, largest{};
          ContactValues<Pack> c{};
          DiscValues<Pack>    i{}, j{};
          for (; k + pack_size <= n; k += pack_size)
            {
              const Contact *const p = contacts + k;
              load(p, c);
              load(discs[p[0].i], discs[p[1].i], discs[p[2].i], discs[p[3].i], i);
              load(discs[p[0].j], discs[p[1].j], discs[p[2].j], discs[p[3].j], j);
              Pack weight = {1., 1., 1., 1.};
              if (problem.communicator != nullptr)
                for (unsigned int m = 0; m < pack_size; ++m)
                  weight[m] = problem.counts(p[m]) ? 1. : 0.;
              add_residual(c, i, j, weight, terms.shift, change, largest);
            }
          for (unsigned int m = 0; m < pack_size; ++m)
            {
              terms.change += change[m];
              raise_to(terms.largest, double(largest[m]));
            }
        }
      for (; k < n; ++k)
        add_residual(values(contacts[k]),
                     values(discs[contacts[k].i]),
                     values(discs[contacts[k].j]),
                     problem.counts(contacts[k]) ? 1. : 0.,
                     terms.shift,
                     terms.change,
                     terms.largest);
    }

    using Residuals = void(const ContactProblem &, ResidualTerms &);

    void residuals_plain(const ContactProblem &problem, ResidualTerms &terms)
    {
      add_residuals<false>(problem, terms);
    }

#ifdef __x86_64__
    __attribute__((target("avx2"))) void residuals_avx2(const ContactProblem &problem, ResidualTerms &terms)
    {
      add_residuals<true>(problem, terms);
    }

    Residuals *const best_residuals = __builtin_cpu_supports("avx2") ? residuals_avx2 : residuals_plain;
#else
    Residuals *const best_residuals = residuals_plain;
#endif
    /** See ContactTolerance: what is missing of the impulse of the heaviest disc, over what it should be. */
    double missing_impulse(const ContactProblem &problem)
    {
      double largest[2] = {0., 0.}; // velocity of a violation, impulse
      for (const Contact &c : problem.contacts)
        {
          const Disc &i = problem.discs[c.i], &j = problem.discs[c.j];
          double      rn, rt;
          FrictionCone::solve(values(c), values(i), values(j), rn, rt);
          const double normal = i.inverse_mass + j.inverse_mass;
          // friction that slides is violated by what the normal impulse still changes, no more
          largest[0] = std::max(largest[0], std::hypot(rn - c.rn, rt - c.rt) * normal);
          largest[1] = std::max(largest[1], std::hypot(c.rn, c.rt));
        }
      if (problem.communicator != nullptr)
        problem.communicator->max(largest, 2);
      const double wanted = std::max(largest[1], problem.heaviest * problem.velocity_scale);
      return wanted > 0. ? problem.heaviest * largest[0] / wanted : 0.;
    }
  } // namespace

  void measure_residual(const ContactMeasure &measure, ContactSolution &solution)
  {
    const ContactProblem &problem = measure.problem;
    ReproducibleSum       change  = measure.begin().change;
    double                largest = 0.;
    // A maximum needs no bound; if the sum outgrows its own, once more with what the maximum allows.
    for (int attempt = 0; attempt < 2; ++attempt)
      {
        ResidualTerms terms;
        terms.shift = change.unit_shift();
        best_residuals(problem, terms);
        change.add_rounded(terms.change);
        largest = terms.largest;
        for (std::size_t k = 0; k < problem.rolling.size(); ++k)
          if (const Contact &c = problem.contacts[k]; problem.counts(c))
            {
              const RollingFriction &r = problem.rolling[k];
              const double moved = solve_rolling(r, c, problem.discs[c.i], problem.discs[c.j], r.impulse) - r.impulse;
              change.add(moved * moved);
              largest = std::max(largest, moved * moved);
            }
        if (problem.communicator != nullptr)
          {
            double all = change.value();
            problem.communicator->sum(&all, 1);
            problem.communicator->max(&largest, 1);
            change.set(all);
          }
        if (change.holds())
          break;
        change = ReproducibleSum(measure.n_contacts() * largest);
      }
    const double n     = std::max(1., measure.n_contacts());
    solution.residual  = std::sqrt(change.value() / n) / problem.impulse_scale;
    solution.violation = std::sqrt(largest) / problem.impulse_scale;
    solution.missing   = problem.heaviest > 0. ? missing_impulse(problem) : 0.;
  }

  void give_up(ContactMeasure &measure, const ContactTolerance &tolerance, ContactSolution &solution)
  {
    constexpr double      little  = 1e-2;
    const ContactProblem &problem = measure.problem;
    measure_residual(measure, solution);
    if (problem.correction != nullptr)
      solution.smooth = problem.correction->estimate(problem, solution.sweeps).velocity / problem.velocity_scale;
    const auto change = measure.velocity_change();
    solution.stalled  = change && (*change)[0] <= little * std::max(problem.velocity_scale, (*change)[1]) &&
                       solution.missing <= tolerance.missing &&
                       solution.smooth <= tolerance.stagnation_factor * tolerance.smooth;
  }

  bool is_solved(ContactMeasure         &measure,
                 const SweepSums        &sums,
                 const ContactTolerance &tolerance,
                 ContactSolution        &solution,
                 const double            stride)
  {
    // a cold bed may creep towards its solution for as long as it is deep
    if (!tolerance.at_rest && solution.sweeps >= tolerance.max_sweeps / 2)
      measure.remember_velocities();
    const double allowance = tolerance.allowance(solution.sweeps);
    if (!(measure.relative_change(sums) <= stride * allowance * tolerance.residual))
      return false;
    const ContactProblem   &problem = measure.problem;
    MomentCorrection *const moments = problem.correction;
    if (moments != nullptr && !moments->may_look(solution.sweeps))
      return false;
    solution.smooth = 0.;
    measure_residual(measure, solution);
    if (!solution.meets(tolerance))
      return false;
    if (moments != nullptr)
      {
        const double limit = allowance * tolerance.smooth * problem.velocity_scale;
        const double left  = moments->velocity(problem, measure.kinetic_energy(), solution.sweeps, limit);
        solution.smooth    = left / problem.velocity_scale;
        if (left > limit)
          {
            moments->disappoint(solution.sweeps);
            return false;
          }
      }
    solution.converged = true;
    return true;
  }
} // namespace alluvium::contacts
