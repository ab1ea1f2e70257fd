#pragma once

#include <alluvium/grains/contact_problem.h>
#include <alluvium/grains/grain_arrays.h>

#include <array>
#include <vector>

namespace alluvium::grains
{
  /** The grains as the contact problem of one sub-step sees them: velocities without contacts, and inverse masses. */
  class ContactBodies
  {
  public:
    // Stand for walls; several, so that wall contacts in a row stay independent.
    static constexpr std::size_t n_dummies = 16;

    std::vector<Disc> start; // velocities at the start of the sub-step; n_discs
    // At its end without contacts, with inverse masses; n_discs + n_dummies.
    std::vector<Disc> free;

    /** Set them for a sub-step of length @p h [s]. */
    void set(const GrainArrays &grains, const GrainLoads &loads, double h, bool rotation);

    std::size_t n_discs() const { return start.size(); }
  };

  /** The largest and the second largest speed of the first @p n of @p velocities [m/s]. */
  std::array<double, 2> largest_speeds(const std::vector<Disc> &velocities, std::size_t n);

  /** Root mean square of the speeds of the @p n_all discs of all ranks, of which this one has @p n [m/s]. Collective.
   */
  double root_mean_square_speed(const std::vector<Disc> &velocities,
                                std::size_t              n,
                                std::size_t              n_all,
                                ContactCommunicator     *communicator);
} // namespace alluvium::grains
