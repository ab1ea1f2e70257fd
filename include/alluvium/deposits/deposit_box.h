#pragma once

#include <alluvium/deposits/deposit.h>

#include <array>
#include <string>

namespace alluvium::deposits
{
  /** A rectangle that a deposit fills [m]. */
  struct DepositBox
  {
    std::array<double, 2> lower, upper;
    std::array<bool, 2>   periodic = {{false, false}}; // in x and y: its sides are those of a periodic domain

    double width() const { return upper[0] - lower[0]; }
    double height() const { return upper[1] - lower[1]; }

    grains::Periodicity periodicity() const
    {
      return {lower, {{periodic[0] ? width() : 0., periodic[1] ? height() : 0.}}};
    }
  };

  /** The text of the parameters named 'Box'. */
  constexpr const char *deposit_box_prose =
    "The rectangle to fill: xmin, ymin, xmax, ymax [m]. Empty: the bounding "
    "box of the domain. Where it reaches from one "
    "side of a periodic domain to the other, grains lie across the periodic boundary.";

  /** The rectangle that @p text (four numbers, or empty for the domain of @p context) stands for. Throws UserError. */
  DepositBox parse_deposit_box(const std::string &text, const DepositContext &context);
} // namespace alluvium::deposits
