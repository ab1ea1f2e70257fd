#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/grains/grain_arrays.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** The grains as the contact problem of one sub-step sees them: velocities without contacts, and inverse masses. */
  class ContactBodies
  {
  public:
    // Stand for walls; several, so that wall contacts in a row stay independent.
    static constexpr std::size_t n_dummies = 16;

    // At the end of the sub-step, if there were no contacts, with inverse masses; n_discs + n_dummies.
    std::vector<Disc> free;

    /** Set them for a sub-step of length @p h [s]. */
    void set(const grains::GrainArrays &grains, const grains::GrainLoads &loads, double h, bool rotation);

    std::size_t n_discs() const { return free.size() - n_dummies; }
  };

  /** The largest and the second largest speed of the first @p n of @p velocities [m/s]. */
  std::array<double, 2> largest_speeds(const std::vector<Disc> &velocities, std::size_t n);

  /** How fast grains are, those of all ranks. */
  struct GrainSpeeds
  {
    std::array<double, 2> largest{}; // [m/s]
    double                mean = 0.; // root mean square
  };

  /** Of the first @p n of @p grains, which this rank owns, and those of all others. Collective. */
  GrainSpeeds measure_speeds(const grains::GrainArrays &grains,
                             std::size_t                n,
                             std::size_t                n_all,
                             ContactCommunicator       *communicator);
} // namespace alluvium::contacts
