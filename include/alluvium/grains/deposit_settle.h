#pragma once

#include <alluvium/grains/deposit.h>
#include <alluvium/grains/deposit_box.h>

#include <vector>

namespace alluvium::grains
{
  /** What a bed settles under: gravity g [m/s^2] downwards, friction between grains and with floor and sides of the
   * box. */
  struct Settling
  {
    DepositBox box;
    double     g, friction;
  };

  /** How a bed has settled. */
  struct SettledState
  {
    unsigned int n_steps          = 0;  // that it took
    double       speed            = 0.; // root mean square of the grains' mean velocities over the last steps [m/s]
    double       support          = 0.; // vertical force on floor and sides over the weight, mean of the last steps
    double       mean_penetration = 0.; // over the overlapping contacts [m]
    double       packing          = 0.; // inner_packing_fraction()
  };

  /**
   * Let the grains go under gravity, on a floor and between walls of the box, until they stand still and the walls
   * carry them: at first in a thick fluid, so that they creep into place, then without it. Sorts @p seeds into rows,
   * which is the order that contacts like best. Throws UserError if the bed does not come to rest.
   */
  SettledState bring_to_rest(const Settling &settling, std::vector<Seed> &seeds);
} // namespace alluvium::grains
