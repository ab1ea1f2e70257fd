#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_pack.h>
#include <alluvium/contacts/solvers/contact_solver.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    /** What the natural map changes in a pass over all contacts: sums of terms rounded with a shift, and maxima. */
    struct ResidualTerms
    {
      double shift_change = 0., shift_size = 0.; // see ReproducibleSum
      double change = 0., size = 0., largest_change = 0., largest_size = 0.;
    };

    /** One contact, or several, of which those with @p weight 1 count and those with 0 do not. */
    template <typename T>
    ALLUVIUM_INLINE void add_residual(const ContactValues<T> &c,
                                      const DiscValues<T>    &i,
                                      const DiscValues<T>    &j,
                                      const T                &weight,
                                      const ResidualTerms    &shifts,
                                      T                      &change,
                                      T                      &size,
                                      T                      &largest_change,
                                      T                      &largest_size)
    {
      T rn, rt;
      FrictionCone::solve(c, i, j, rn, rt);
      const T changed = weight * ((rn - c.rn) * (rn - c.rn) + (rt - c.rt) * (rt - c.rt)),
              square  = weight * (c.rn * c.rn + c.rt * c.rt);
      change += (changed + shifts.shift_change) - shifts.shift_change;
      size += (square + shifts.shift_size) - shifts.shift_size;
      raise_to(largest_change, changed);
      raise_to(largest_size, square);
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
          Pack                change{}, size{}, largest_change{}, largest_size{};
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
              add_residual(c, i, j, weight, terms, change, size, largest_change, largest_size);
            }
          for (unsigned int m = 0; m < pack_size; ++m)
            {
              terms.change += change[m];
              terms.size += size[m];
              raise_to(terms.largest_change, double(largest_change[m]));
              raise_to(terms.largest_size, double(largest_size[m]));
            }
        }
      for (; k < n; ++k)
        add_residual(values(contacts[k]),
                     values(discs[contacts[k].i]),
                     values(discs[contacts[k].j]),
                     problem.counts(contacts[k]) ? 1. : 0.,
                     terms,
                     terms.change,
                     terms.size,
                     terms.largest_change,
                     terms.largest_size);
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
    ContactMeasure::Sums  sums    = measure.begin();
    double                largest[2];
    // A maximum needs no bound; if the sums outgrow theirs, once more with what the maxima allow.
    for (int attempt = 0; attempt < 2; ++attempt)
      {
        ResidualTerms terms;
        terms.shift_change = sums.change.unit_shift();
        terms.shift_size   = sums.size.unit_shift();
        best_residuals(problem, terms);
        sums.change.add_rounded(terms.change);
        sums.size.add_rounded(terms.size);
        largest[0]     = terms.largest_change;
        largest[1]     = terms.largest_size;
        const auto add = [&](const double change, const double size) {
          sums.change.add(change);
          sums.size.add(size);
          largest[0] = std::max(largest[0], change);
          largest[1] = std::max(largest[1], size);
        };
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
    solution.missing   = problem.heaviest > 0. ? missing_impulse(problem) : 0.;
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
} // namespace alluvium::contacts
