#pragma once

#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_box.h>

#include <vector>

namespace alluvium::deposits
{
  /** What a bed settles under: gravity g [m/s^2] downwards, friction between grains and with floor and sides of the
   * box. */
  struct Settling
  {
    DepositBox box;
    double     g, friction;
    bool       loose = false; // poured such that it cannot stand

    std::vector<grains::WallSegment> walls = {}; // in the box
  };

  /** How a bed has settled. */
  struct SettledState
  {
    unsigned int n_steps          = 0;  // that it took
    double       speed            = 0.; // root mean square of the grains' mean velocities over the last ten steps [m/s]
    double       support          = 0.; // vertical force on floor and sides over the weight, mean of the last steps
    double       mean_penetration = 0.; // over the overlapping contacts [m]
    double       packing          = 0.; // inner_packing_fraction()
  };

  /** To be raised whenever bring_to_rest() or the contact solver would make another bed: cached beds are made anew. */
  constexpr unsigned int settling_version = 5;

  /**
   * Let the grains creep into place under gravity, on a floor and between walls of the box, in a fluid so thick that
   * nothing swings; a loose bed falls with a coarse tolerance first. The bed is at rest when in ten steps no more than
   * one grain in 10,000 moves by 1e-3 diameters, and the walls carry the weight within 1e-3; then contact forces are
   * forgotten, and it comes to rest once more. Sorts
   * @p new_grains into rows, which is the order that contacts like best. Throws UserError if the bed does not come to
   * rest.
   */
  SettledState bring_to_rest(const Settling &settling, std::vector<NewGrain> &new_grains);
} // namespace alluvium::deposits
