#pragma once

#include <alluvium/grains/deposit.h>
#include <alluvium/grains/deposit_box.h>

#include <vector>

namespace alluvium::grains
{
  /** How still a bed is. */
  struct Stillness
  {
    unsigned int n_steps          = 0;  // that it took
    double       speed            = 0.; // root mean square over the grains, over g dt
    double       support          = 0.; // vertical force on the walls over the weight
    double       mean_penetration = 0.; // over the overlapping contacts [m]
  };

  /** What a bed settles under: gravity g [m/s^2] downwards, friction between grains and with the walls of the box. */
  struct Settling
  {
    DepositBox box;
    double     g, friction;
  };

  /**
   * Let the grains go under gravity, on a floor and between walls of the box, until they stand still and the walls carry
   * them: at first in a thick fluid, so that they creep into place, then without it. Sorts @p seeds into rows, which is
   * the order that contacts like best. Throws UserError if the bed does not come to rest.
   */
  Stillness bring_to_rest(const Settling &settling, std::vector<Seed> &seeds);

  /** Walls of the bed: floor, left, right, in this order. */
  std::vector<WallSegment> settling_walls(const DepositBox &box);
} // namespace alluvium::grains
