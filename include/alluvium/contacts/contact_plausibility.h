#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>

namespace alluvium::contacts
{
  /** Sums over all discs that something can move: mass [kg/m], mass times speed [N s/m], and kinetic energy [J/m]. */
  struct MotionSums
  {
    double mass = 0., momentum = 0., energy = 0.;
  };

  /**
   * Of the first @p n of @p discs, those that this rank owns, and those of all other ranks; see sum_over_ranks() for
   * @p n_all. Collective, like the others.
   */
  MotionSums
  sum_motion(const std::vector<Disc> &discs, std::size_t n, std::size_t n_all, ContactCommunicator *communicator);

  /**
   * Whether the @p largest impulse is far larger than what the motion @p before could ask for. Friction can lock a disc
   * in a wedge that restitution or the opening of an overlap wants to push it out of: no finite impulses do that, and
   * the solver piles them up until the tolerance, which is relative to them, is met by anything. @p extra [m/s] is the
   * speed that walls and the opening of overlaps add.
   */
  bool has_diverged(double largest, const MotionSums &before, double extra);

  /**
   * Whether impacts have made energy. Newton's restitution does where several meet in one sub-step: a disc that is hit
   * by one neighbour while another leaves it takes the other along, and the first still bounces at its full speed.
   */
  bool has_gained_energy(const ContactProblem &problem, std::size_t n_all, const MotionSums &before, double extra);
} // namespace alluvium::contacts
