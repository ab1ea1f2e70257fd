#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <array>
#include <optional>
#include <vector>

namespace alluvium::contacts
{
  /** What a sweep leaves behind besides new impulses, on all ranks. */
  struct SweepSums
  {
    double change = 0.; // sum of squared impulse changes [(N s/m)^2]
    double size   = 0.; // sum of squared impulses
    double work   = 0.; // sum of bias . impulse, part of the objective [J/m]
  };

  /**
   * The sums of a contact solve: how far it is, and its objective. They have the same bits on any number of ranks,
   * for which bounds of the sums to come are kept, from those before. A sum that outgrows its bound comes out as
   * infinite, which passes for "not converged"; the next bound is larger.
   */
  class ContactMeasure
  {
  public:
    /** Start with bounds from the warm impulses and the biases. Collective. */
    explicit ContactMeasure(const ContactProblem &problem);

    /** The sums of one sweep, as this rank adds them up. */
    struct Sums
    {
      ReproducibleSum change, size, work;
    };
    Sums begin() const
    {
      return {ReproducibleSum(change_bound), ReproducibleSum(size_bound), ReproducibleSum(work_bound)};
    }

    /** The sums over all ranks; new bounds. Collective. */
    SweepSums end(Sums sums);

    /** Relative change of a sweep, in the measure of ContactTolerance. */
    double relative_change(const SweepSums &sums) const;

    /** Kinetic energy of all discs that can move [J/m]. Collective. */
    double kinetic_energy();

    /** Keep the velocities as they are, once, to see how much they change from here on. */
    void remember_velocities();

    /** Root mean square of the velocities' change since then, and of the velocities [m/s]; none if not kept.
     * Collective. */
    std::optional<std::array<double, 2>> velocity_change() const;

    /** Number of contacts on all ranks. */
    double n_contacts() const { return n; }

    const ContactProblem &problem;

  private:
    double n            = 0.;
    double bias         = 0.; // sum of squared biases
    double change_bound = 0., size_bound = 0., work_bound = 0., energy_bound = 0.;

    std::vector<std::array<double, 3>> remembered; // velocities of owned discs

    void bound_work();
  };
} // namespace alluvium::contacts
