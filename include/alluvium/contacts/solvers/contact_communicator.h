#pragma once

#include <vector>

namespace alluvium::contacts
{
  struct Disc;

  /**
   * What a contact solve over several ranks asks of the others. All calls are collective: a distributed problem has the
   * same number of colours on every rank, also where some are empty.
   */
  class ContactCommunicator
  {
  public:
    virtual ~ContactCommunicator() = default;

    /** Bring the velocities of ghost discs up to date after the contacts of @p colour were relaxed. */
    virtual void after_colour(std::vector<Disc> &discs, unsigned int colour) = 0;

    /** The same for all ghost discs, whatever changed. */
    virtual void update_ghosts(std::vector<Disc> &discs) = 0;

    /** Sums, and maxima, of @p n values over all ranks, in place. */
    virtual void sum(double *values, unsigned int n) = 0;
    virtual void max(double *values, unsigned int n) = 0;
  };
} // namespace alluvium::contacts
