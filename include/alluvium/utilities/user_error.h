#pragma once

#include <stdexcept>
#include <string>

namespace alluvium
{
  /**
   * A mistake in what the user gave us (parameter file, data file, command line, file system). The text names the
   * parameter, file or line and what was expected; main() prints it alone, without a stack trace, and exits with 1.
   * Our own bugs are `Assert`s instead.
   */
  class UserError : public std::runtime_error
  {
  public:
    explicit UserError(const std::string &message)
      : std::runtime_error(message)
    {}
  };

  /** Throw a UserError with @p message unless @p condition holds. */
  inline void check_user(const bool condition, const std::string &message)
  {
    if (!condition)
      throw UserError(message);
  }
} // namespace alluvium
