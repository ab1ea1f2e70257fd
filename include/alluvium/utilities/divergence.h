#pragma once

#include <stdexcept>
#include <string>

namespace alluvium
{
  /**
   * The computation has run away: what it holds means nothing any more. The text says what, where and when, by which
   * sign, and what to try; the program prints it alone and exits with 3.
   */
  class Divergence : public std::runtime_error
  {
  public:
    explicit Divergence(const std::string &message)
      : std::runtime_error(message)
    {}
  };
} // namespace alluvium
