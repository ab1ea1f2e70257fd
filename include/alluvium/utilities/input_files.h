#pragma once

#include <string>
#include <vector>

namespace alluvium
{
  /** Remember that this process has read @p path: what it writes must not take its place. */
  void note_input(const std::string &path);

  /** What note_input() was told, in that order, each once. */
  const std::vector<std::string> &noted_inputs();

  /** Checksum of a file's content, or empty if it cannot be read. */
  std::string digest_of_file(const std::string &path);
} // namespace alluvium
