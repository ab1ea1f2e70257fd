#pragma once

#include <alluvium/contacts/solvers/contact_cone.h>
#include <alluvium/contacts/solvers/contact_problem.h>

namespace alluvium::contacts
{
  /** Give new velocities back to a disc. */
  inline void set_velocity(Disc &disc, const DiscValues<double> &values)
  {
    disc.x = values.x;
    disc.y = values.y;
    disc.s = values.s;
  }

  /** Add an impulse (pn, pt) of a contact to the velocities of its discs. */
  inline void push(ContactProblem &problem, const Contact &contact, const double pn, const double pt)
  {
    Disc              &disc_i = problem.discs[contact.i], &disc_j = problem.discs[contact.j];
    DiscValues<double> i = values(disc_i), j = values(disc_j);
    push(values(contact), i, j, pn, pt);
    set_velocity(disc_i, i);
    set_velocity(disc_j, j);
  }

  /** Solve the rolling friction of contact @p k, if there is any, with all else held; squared change of its impulse. */
  inline double relax_rolling(ContactProblem &problem, const std::size_t k)
  {
    if (problem.rolling.empty())
      return 0.;
    const Contact   &contact = problem.contacts[k];
    RollingFriction &rolling = problem.rolling[k];
    Disc            &i = problem.discs[contact.i], &j = problem.discs[contact.j];
    const double impulse = solve_rolling(rolling, contact, i, j, rolling.impulse), change = impulse - rolling.impulse;
    roll(rolling, i, j, change);
    rolling.impulse = impulse;
    return change * change;
  }

  /**
   * Solve contact @p k with all others held, for solvers that choose their contacts one by one. The discs' inverse
   * masses count @p factor_i and @p factor_j times for that. Returns the squared change of its impulse.
   */
  inline double
  relax(ContactProblem &problem, const std::size_t k, const double factor_i = 1., const double factor_j = 1.)
  {
    Contact           &contact = problem.contacts[k];
    DiscValues<double> i = values(problem.discs[contact.i]), j = values(problem.discs[contact.j]);
    i.inverse_mass *= factor_i;
    i.inverse_rotation *= factor_i;
    j.inverse_mass *= factor_j;
    j.inverse_rotation *= factor_j;
    double rn, rt;
    FrictionCone::solve(values(contact), i, j, rn, rt);
    const double dn = rn - contact.rn, dt = rt - contact.rt;
    push(problem, contact, dn, dt);
    contact.rn = rn;
    contact.rt = rt;
    return dn * dn + dt * dt + relax_rolling(problem, k);
  }
} // namespace alluvium::contacts
