#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_pack.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::contacts
{
  namespace
  {
    constexpr double head_room = 16.;    // by how much a sum may grow from sweep to sweep
    constexpr double leap      = 0x1p20; // the next bound after a sum has outgrown its own
    constexpr double infinity  = std::numeric_limits<double>::infinity();

    /** Sum of v.M v / 2 over discs, of terms rounded as @p sum does; immovable ones count as nothing. */
    template <typename T>
    ALLUVIUM_INLINE void add_energy(const DiscValues<T> &d, const T &shift, T &sum)
    {
      const T none{};
      const T translation = d.inverse_mass > 0. ? 0.5 / d.inverse_mass : none;
      const T rotation    = d.inverse_rotation > 0. ? 0.5 / d.inverse_rotation : none;
      sum += (translation * (d.x * d.x + d.y * d.y) + rotation * (d.s * d.s) + shift) - shift;
    }

    template <bool packed>
    ALLUVIUM_INLINE double energy_of(const Disc *const discs, const std::size_t n, const double shift)
    {
      const std::size_t n_packs = packed ? n / pack_size : 0;
      double            sum     = 0.;
      if constexpr (packed)
        {
          Pack             sums{};
          const Pack       shifts = Pack{} + shift;
          DiscValues<Pack> values{};
          for (std::size_t k = 0; k < pack_size * n_packs; k += pack_size)
            {
              load(discs[k], discs[k + 1], discs[k + 2], discs[k + 3], values);
              add_energy(values, shifts, sums);
            }
          sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        }
      for (std::size_t k = pack_size * n_packs; k < n; ++k)
        add_energy(values(discs[k]), shift, sum);
      return sum;
    }

    using Energy = double(const Disc *, std::size_t, double);

    double energy_plain(const Disc *const discs, const std::size_t n, const double shift)
    {
      return energy_of<false>(discs, n, shift);
    }

#ifdef __x86_64__
    __attribute__((target("avx2"))) double energy_avx2(const Disc *const discs, const std::size_t n, const double shift)
    {
      return energy_of<true>(discs, n, shift);
    }

    Energy *const best_energy = __builtin_cpu_supports("avx2") ? energy_avx2 : energy_plain;
#else
    Energy *const best_energy = energy_plain;
#endif

    /** The bound of the next sum of this kind, and what to say of this one. */
    double update(double &bound, const ReproducibleSum &sum)
    {
      if (!sum.holds())
        {
          bound *= leap;
          return infinity;
        }
      bound = head_room * sum.value();
      return sum.value();
    }
  } // namespace

  ContactMeasure::ContactMeasure(const ContactProblem &problem)
    : problem(problem)
  {
    double largest[2] = {problem.impulse_scale * problem.impulse_scale, 0.};
    for (const Contact &c : problem.contacts)
      {
        largest[0] = std::max(largest[0], c.rn * c.rn + c.rt * c.rt);
        largest[1] = std::max(largest[1], c.bias_n * c.bias_n + c.bias_t * c.bias_t);
        n += problem.counts(c);
      }
    if (problem.communicator != nullptr)
      {
        problem.communicator->max(largest, 2);
        problem.communicator->sum(&n, 1);
      }
    size_bound   = head_room * n * largest[0];
    change_bound = 1e-6 * size_bound;
    bias         = n * largest[1];
    bound_work();
  }

  void ContactMeasure::bound_work()
  {
    // Cauchy and Schwarz: holds for any partial sum, as long as the bound of the impulses does
    work_bound = 2. * std::sqrt(2. * size_bound * bias);
  }

  SweepSums ContactMeasure::end(Sums sums)
  {
    if (problem.communicator != nullptr)
      {
        double all[3] = {sums.change.value(), sums.size.value(), sums.work.value()};
        problem.communicator->sum(all, 3);
        sums.change.set(all[0]);
        sums.size.set(all[1]);
        sums.work.set(all[2]);
      }
    SweepSums  result;
    const bool work_holds = sums.size.holds();
    result.change         = update(change_bound, sums.change);
    result.size           = update(size_bound, sums.size);
    result.work           = work_holds ? sums.work.value() : infinity;
    // Changes this small, or impulses that all vanished, must not leave bounds of zero behind.
    const double least = n * problem.impulse_scale * problem.impulse_scale;
    size_bound         = std::max(size_bound, least);
    change_bound       = std::max(change_bound, 1e-36 * size_bound);
    bound_work();
    return result;
  }

  double ContactMeasure::relative_change(const SweepSums &sums) const
  {
    if (!std::isfinite(sums.change) || !std::isfinite(sums.size))
      return infinity;
    return std::sqrt(sums.change / std::max(1., n)) / problem.impulse_scale;
  }

  void ContactMeasure::remember_velocities()
  {
    if (!remembered.empty())
      return;
    remembered.reserve(problem.n_owned_discs);
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      remembered.push_back({{problem.discs[k].x, problem.discs[k].y, problem.discs[k].s}});
  }

  std::optional<std::array<double, 2>> ContactMeasure::velocity_change() const
  {
    if (!any_over_ranks(problem.communicator, !remembered.empty()))
      return {};
    const std::size_t n_owned = remembered.size(), n_all = count_over_ranks(problem.communicator, n_owned);
    auto              sums =
      sum_over_ranks<2>(problem.communicator, n_owned, n_all, [&](const std::size_t k) -> std::array<double, 2> {
        const Disc  &d = problem.discs[k];
        const auto  &v = remembered[k];
        const double x = d.x - v[0], y = d.y - v[1], s = d.s - v[2];
        return {{x * x + y * y + s * s, d.x * d.x + d.y * d.y + d.s * d.s}};
      });
    for (double &sum : sums)
      sum = std::sqrt(sum / n_all);
    return sums;
  }

  double ContactMeasure::kinetic_energy()
  {
    while (true)
      {
        ReproducibleSum energy(energy_bound);
        energy.set(best_energy(problem.discs.data(), problem.n_owned_discs, energy.unit_shift()));
        if (problem.communicator != nullptr)
          {
            double all = energy.value();
            problem.communicator->sum(&all, 1);
            energy.set(all);
          }
        if (energy.holds() || !std::isfinite(energy.value()))
          {
            energy_bound = head_room * energy.value();
            return energy.value();
          }
        energy_bound = std::max(energy_bound * leap, 1e-3 * problem.impulse_scale * problem.impulse_scale);
      }
  }
} // namespace alluvium::contacts
