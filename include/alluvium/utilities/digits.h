#pragma once

#include <string>

namespace alluvium
{
  /** @p x for a message: up to six significant digits, as streams print it. */
  std::string in_digits(double x);

  /** The same with up to three. */
  std::string rounded(double x);
} // namespace alluvium
