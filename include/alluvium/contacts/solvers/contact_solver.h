#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/utilities/plugin_interface.h>

#include <algorithm>
#include <string>

namespace alluvium::contacts
{
  /**
   * When a contact solution is good enough. Residual and violation are about the natural map: how far an impulse would
   * still move if its contact alone were solved once more, over the problem's impulse scale. So they bound with which
   * speed discs that touch move on one another where they should not, over g dt, however much they carry. Where that
   * takes more than `stagnation_sweeps` sweeps (grains slide, and friction is no minimisation), less and less is asked:
   * with the fourth power of the sweeps, up to `stagnation_factor`.
   *
   * In a bed at rest (one with a MomentCorrection) the smooth part of the velocities, to which the residual is blind,
   * must be small too.
   *
   * A light disc's contact can hardly move the impulse that a heavy one wants of it. Where masses differ by thousands
   * the velocity with which any contact is violated counts too: the heaviest mass times it is an impulse that is
   * missing, and must be small against the largest impulse, or that of the heaviest disc's own weight.
   */
  struct ContactTolerance
  {
    double       residual          = 4e-5; // root mean square over the contacts
    double       violation         = 1e-2; // maximum over the contacts
    double       stagnation_factor = 100.;
    unsigned int stagnation_sweeps = 30;
    bool         at_rest           = false; // nothing is thought to move, as in a cold start
    unsigned int max_sweeps        = 2000;  // then the solver gives up, and the caller takes a smaller sub-step
    double       missing           = 1e-2;  // impulse of the heaviest disc; in no case less is asked
    double       smooth            = 1e-3;  // velocity, over g dt

    double allowance(const unsigned int sweeps) const
    {
      const double over = static_cast<double>(sweeps) / stagnation_sweeps;
      return std::clamp(over * over * over * over, 1., std::max(1., stagnation_factor));
    }
  };

  /** How a solve ended. */
  struct ContactSolution
  {
    bool         converged = false;
    bool         stalled   = false; // not converged, and more sweeps change the velocities no more
    unsigned int sweeps    = 0;     // sweeps over all contacts
    double       residual = 0., violation = 0., missing = 0., smooth = 0.;

    /** Whether the numbers meet @p tolerance after so many sweeps. */
    bool meets(const ContactTolerance &tolerance) const
    {
      const double allowance = tolerance.allowance(sweeps);
      return residual <= allowance * tolerance.residual && violation <= allowance * tolerance.violation &&
             missing <= tolerance.missing && smooth <= allowance * tolerance.smooth;
    }
  };

  /**
   * Interface of the plug-ins that solve a ContactProblem: from free velocities and warm impulses to final ones. They
   * must be deterministic. Over several ranks they are collective, speak through the problem's communicator only, and
   * must find the same bits on any number of them, or refuse.
   */
  class ContactSolver : public Plugin
  {
  public:
    virtual ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const = 0;
  };

  /** Throw a UserError if @p problem is spread over several ranks, which the solver named @p solver cannot handle. */
  void refuse_ranks(const ContactProblem &problem, const std::string &solver);

  class ContactMeasure;
  struct SweepSums;

  /**
   * The natural-map residual of the problem of @p measure as it stands: fills `residual`, `violation` and
   * `missing` of @p solution. Collective.
   */
  void measure_residual(const ContactMeasure &measure, ContactSolution &solution);

  /**
   * End a solve that has taken its largest number of sweeps: fills @p solution. A solve has stalled if over the second
   * half of its sweeps the velocities have changed by less than 1e-2 of g dt, or of their own size, root mean square.
   * Collective.
   */
  void give_up(ContactMeasure &measure, const ContactTolerance &tolerance, ContactSolution &solution);

  /**
   * Whether the problem is solved to @p tolerance, after a sweep that changed impulses by @p sums. The changes of a
   * sweep only hint at the residual after it, so it is measured before they are believed, but only if they are small
   * enough; a sweep of this solver moves an impulse by about @p stride times its distance from its law. Fills
   * @p solution, but for its sweeps, which must be right before. Collective.
   */
  bool is_solved(ContactMeasure         &measure,
                 const SweepSums        &sums,
                 const ContactTolerance &tolerance,
                 ContactSolution        &solution,
                 double                  stride = 1.);
} // namespace alluvium::contacts
