#pragma once

#include <alluvium/deposits/deposit_box.h>

#include <string>

namespace alluvium::deposits
{
  /** Mean area of discs whose diameters are uniform between @p d_min [m] and @p ratio times that [m^2]. */
  double uniform_disc_area(double d_min, double ratio);

  /** Throws UserError if @p d [m], a @p parameter of the deposit @p name, is no diameter of a grain. */
  void check_diameter(const std::string &name, const std::string &parameter, double d);

  /**
   * Throws UserError, for the deposit @p name, if @p n discs of a mean area [m^2] cannot fit @p box however they lie:
   * their area alone says so. Chance has its part in the area of few discs.
   */
  void check_area(const std::string &name, double n, double mean_area, const DepositBox &box);

  /**
   * Throws UserError if @p n grains are more than any run could have, or very many in a box that is more than 20,000 of
   * the @p largest diameter [m] wide; with a guess at the unit of length.
   */
  void check_number(const std::string &name, double n, const DepositBox &box, double largest);
} // namespace alluvium::deposits
