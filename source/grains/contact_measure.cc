#include <alluvium/grains/contact_measure.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::grains
{
  namespace
  {
    constexpr double head_room = 16.;    // by how much a sum may grow from sweep to sweep
    constexpr double leap      = 0x1p20; // the next bound after a sum has outgrown its own
    constexpr double infinity  = std::numeric_limits<double>::infinity();

    double kinetic_energy_of(const Disc &d)
    {
      double energy = 0.;
      if (d.inverse_mass > 0.)
        energy += (d.x * d.x + d.y * d.y) / d.inverse_mass;
      if (d.inverse_rotation > 0.)
        energy += d.s * d.s / d.inverse_rotation;
      return 0.5 * energy;
    }

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
    const double count = std::max(1., n);
    return std::sqrt(sums.change / count) / std::max(std::sqrt(sums.size / count), problem.impulse_scale);
  }

  double ContactMeasure::kinetic_energy()
  {
    while (true)
      {
        ReproducibleSum energy(energy_bound);
        for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
          energy.add(kinetic_energy_of(problem.discs[k]));
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
} // namespace alluvium::grains
