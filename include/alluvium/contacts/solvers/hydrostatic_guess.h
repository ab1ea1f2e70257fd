#pragma once

#include <alluvium/contacts/solvers/coarse_correction.h>
#include <alluvium/contacts/solvers/contact_solver.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** What loads the discs of a bed: along the unit vector `down`, the impulse of each in the sub-step [N s/m]. */
  struct BedWeight
  {
    std::array<double, 2>      down;
    const std::vector<double> &impulse;
  };

  /**
   * Solve a bed of discs in contact whose impulses nobody knows yet. Sweeps carry weight down by about one layer each,
   * so a deep bed takes thousands of them from zero. Instead the contacts start with
   *
   *   rn = 0.6 W (1 + 0.4 (n_down^2 - n_across^2)),    W: weight above a disc's width,
   *
   * and between a few cycles of sweeps, each longer than the one before, CoarseCorrection brings large parts of the bed
   * to rest; unless they turn out to be falling. Then the solver goes on by itself. Collective.
   */
  ContactSolution solve_from_hydrostatic_guess(ContactProblem         &problem,
                                               const DiscPlaces       &places,
                                               const BedWeight        &weight,
                                               const ContactSolver    &solver,
                                               const ContactTolerance &tolerance);
} // namespace alluvium::contacts
