#pragma once

#include <string>

namespace alluvium
{
  /** @p x for a message: up to six significant digits, as streams print it. */
  std::string in_digits(double x);
} // namespace alluvium
