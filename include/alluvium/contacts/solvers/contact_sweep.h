#pragma once

#include <alluvium/contacts/solvers/contact_cone.h>
#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_problem.h>

namespace alluvium::contacts
{
  /** Where a contact's impulse was an iteration ago: the accelerated solvers' own. */
  struct LastImpulse
  {
    double rn, rt;
  };

  enum class SweepOrder
  {
    forward,
    backward
  };

  /** Make the velocities those of "an iteration ago". */
  void remember(ContactProblem &problem);

  /** Move all velocities on by @p beta times their change since an iteration ago; today's become those. */
  void extrapolate(ContactProblem &problem, double beta);

  /**
   * One Gauss-Seidel sweep over all contacts, colour by colour. With @p last, an impulse is first moved on by @p beta
   * times its last change (momentum); extrapolate() has done the same to the velocities. Collective.
   */
  SweepSums sweep(ContactProblem &problem,
                  ContactMeasure &measure,
                  SweepOrder      order = SweepOrder::forward,
                  LastImpulse    *last  = nullptr,
                  double          beta  = 0.);
} // namespace alluvium::contacts
