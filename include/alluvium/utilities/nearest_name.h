#pragma once

#include <string>
#include <vector>

namespace alluvium
{
  /**
   * How many characters have to be inserted, deleted, replaced or swapped with their neighbour to turn @p a into @p b;
   * upper and lower case count as equal.
   */
  unsigned int edit_distance(const std::string &a, const std::string &b);

  /** The one of @p candidates that a misspelt @p name most likely means, or an empty string if none comes close. */
  std::string nearest_name(const std::string &name, const std::vector<std::string> &candidates);
} // namespace alluvium
