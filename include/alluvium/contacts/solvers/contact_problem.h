#pragma once

#include <alluvium/contacts/solvers/contact_communicator.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /**
   * A disc during the sweeps, one cache line. s = radius * omega [m/s], so that rotation needs no lever arms; the
   * velocities of the iteration before are the accelerated solvers' own.
   */
  struct alignas(64) Disc
  {
    double x = 0., y = 0., s = 0.; // velocity [m/s]
    double inverse_mass = 0.;      // effective, of translation [m/kg]; 0: nothing moves it
    double last_x = 0., last_y = 0., last_s = 0.;
    double inverse_rotation = 0.; // r^2 / I [m/kg]; 0: it does not spin
  };

  /**
   * One contact between discs i and j (or a wall in place of j) during one sub-step, one cache line. The normal points
   * from i to j, the tangent is (-ny, nx), the impulse (rn, rt) acts on j and its opposite on i. With the relative
   * velocities
   *
   *   v_n = (v_j - v_i).n                    v_t = (v_j - v_i).t - s_i - s_j
   *
   * the laws are 0 <= v_n + bias_n  _|_  rn >= 0 and Coulomb's |rt| <= mu rn against v_t + bias_t. A disc touches at
   * distance r from its centre along n, so normal and tangent do not see each other: the local problem is two clamps.
   */
  struct alignas(64) Contact
  {
    double        nx, ny;
    double        bias_n, bias_t; // [m/s]
    double        rn, rt;         // [N s/m]
    double        friction;
    std::uint32_t i, j;
  };

  /**
   * Rolling friction of a contact, a third clamp: with the reduced radius R, the moment impulse R impulse acts on disc
   * j and its opposite on i, against
   *
   *   v_r = lever_j s_j - lever_i s_i + bias                   lever = R / radius
   *
   * and |impulse| <= coefficient rn. Only for discs of different size does it see the tangential impulse, so that
   * clamping one after the other converges to what solves all three.
   */
  struct RollingFriction
  {
    double impulse;     // [N s/m]
    double last;        // of the iteration before; the accelerated solvers' own
    double lever_i;     // [-]
    double lever_j;     // [-]; 0 for a wall
    double bias;        // R times the spin of a wall [m/s]
    double coefficient; // [-]
  };

  class MomentCorrection;

  /**
   * All contacts of one sub-step. Walls are bodies that nothing moves: their velocity sits in the biases, and a few
   * dummies behind the discs stand for them.
   *
   * Over several ranks a problem holds the discs that the rank owns, then ghosts, and every contact of an owned disc;
   * one between an owned disc and a ghost is on both ranks, which compute the same bits. It counts in sums where its
   * disc i is owned, so i and j must be the same discs on both.
   */
  struct ContactProblem
  {
    std::vector<Disc>          discs;    // in: free velocities; out: with the contact impulses. Owned, ghosts, dummies
    std::vector<double>        height{}; // of all discs, against gravity [m]; empty without gravity
    std::size_t                n_discs       = 0; // owned and ghosts
    std::size_t                n_owned_discs = 0;
    std::vector<Contact>       contacts;       // in: warm impulses; out: the solution
    std::vector<std::uint32_t> colour_begin{}; // contacts of colour c are [colour_begin[c], colour_begin[c + 1]) and
                                               // share no disc
    std::vector<RollingFriction> rolling{};    // of every contact, or none
    double impulse_scale = 1.; // what impulses are large or small against [N s/m]: mean mass * g * dt, say
    /** Mass of the heaviest disc that moves [kg/m] where it is thousands of times that of the lightest, else 0; and the
     * velocity that gravity gives in the sub-step [m/s]. */
    double            heaviest = 0., velocity_scale = 0.;
    MomentCorrection *correction = nullptr; // of a bed at rest, begun; none where discs move, or where it is not wanted
    ContactCommunicator *communicator = nullptr; // none on one rank

    std::size_t n_colours() const { return colour_begin.empty() ? 0 : colour_begin.size() - 1; }

    /** Whether sums over all ranks take @p contact from this one. */
    bool counts(const Contact &contact) const { return contact.i < n_owned_discs; }

    /** How many contacts they take from this one. */
    std::size_t n_counted() const
    {
      if (communicator == nullptr)
        return contacts.size();
      std::size_t n = 0;
      for (const Contact &c : contacts)
        n += counts(c);
      return n;
    }
  };

  /** Is what solvers rely on true: sizes, numbers of discs, colours that share none? For Assert: it takes a sweep's
   * time. */
  bool is_consistent(const ContactProblem &problem);

  /** Add the velocities that the impulses in @p problem cause to its velocities. */
  void apply_impulses(ContactProblem &problem);
} // namespace alluvium::contacts
