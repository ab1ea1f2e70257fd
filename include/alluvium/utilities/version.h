#pragma once

#include <string>

namespace alluvium
{
  /** The program's version, such as 1.2.3, and the commit that it was built from, if that is known, in brackets. */
  std::string version();
} // namespace alluvium
