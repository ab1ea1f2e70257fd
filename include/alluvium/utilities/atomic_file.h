#pragma once

#include <string>

namespace alluvium
{
  /**
   * Write @p content to a temporary file beside @p file_name and rename it: whoever reads, even after a crash, finds
   * the old file or the new one, whole. Throws a UserError if the disk does not take it.
   */
  void write_atomically(const std::string &file_name, const std::string &content);
} // namespace alluvium
