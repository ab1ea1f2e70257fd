#pragma once

#include <alluvium/grains/contact_problem.h>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::grains
{
  /**
   * When a contact solution is good enough. Both numbers are about the natural map: how far an impulse would still move
   * if its contact alone were solved once more, over the root mean square of the impulses (at least the problem's
   * impulse scale).
   */
  struct ContactTolerance
  {
    double       residual   = 1e-5; // root mean square over the contacts
    double       violation  = 1e-3; // maximum over the contacts
    double       loose      = 10.;  // both may be this much larger ...
    unsigned int patience   = 100;  // ... after this many sweeps: the grains move, and no earlier solution helps
    unsigned int max_sweeps = 2000; // then the solver gives up, and the caller takes a smaller sub-step

    double allowance(const unsigned int sweeps) const { return sweeps < patience ? 1. : loose; }
  };

  /** How a solve ended. */
  struct ContactSolution
  {
    bool         converged = false;
    unsigned int sweeps    = 0; // sweeps over all contacts
    double       residual = 0., violation = 0.;

    /** Whether the numbers meet @p tolerance after so many sweeps. */
    bool meets(const ContactTolerance &tolerance) const
    {
      const double allowance = tolerance.allowance(sweeps);
      return residual <= allowance * tolerance.residual && violation <= allowance * tolerance.violation;
    }
  };

  /**
   * Interface of the plug-ins that solve a ContactProblem: from free velocities and warm impulses to final ones. They
   * must be deterministic. Over several ranks they are collective, speak through the problem's communicator only, and
   * must find the same bits on any number of them, or refuse.
   */
  class ContactSolver
  {
  public:
    virtual ~ContactSolver() = default;
    virtual void            add_parameters(dealii::ParameterHandler &) {}
    virtual ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const = 0;
  };

  class ContactMeasure;

  /**
   * The natural-map residual of the problem of @p measure as it stands: fills `residual` and `violation` of
   * @p solution. Collective.
   */
  void measure_residual(const ContactMeasure &measure, ContactSolution &solution);
} // namespace alluvium::grains
