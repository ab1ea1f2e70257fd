#pragma once

#include <alluvium/grains/deposit.h>
#include <alluvium/grains/deposit_pour.h>

#include <vector>

namespace alluvium::grains
{
  /** Force between a disc and what it lies on: (normal, tangential) on the latter, as in ContactProblem [N/m]. */
  struct SupportForce
  {
    std::size_t disc;
    int         support; // index of a disc, or Pour::floor, left, right
    double      normal, tangential;
  };

  /**
   * The forces that hold a poured bed under gravity @p g [m/s^2], downwards. A disc lies on things that were there
   * before it, so one pass from the last disc to the first finds them: what is known of a disc is its load, what is
   * sought are two normal and two tangential forces. Balance of forces and of the moment leaves one of them free; it is
   * chosen such that friction @p mu suffices and is used as little as possible. Where no choice does (the disc will
   * slip), normal forces are cut off at zero and tangential ones at the friction limit, and balance is lost there.
   */
  std::vector<SupportForce> find_support_forces(const std::vector<Seed>        &seeds,
                                                const std::vector<Pour::Place> &places,
                                                double                          g,
                                                double                          mu);
} // namespace alluvium::grains
