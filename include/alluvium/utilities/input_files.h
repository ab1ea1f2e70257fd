#pragma once

#include <string>
#include <vector>

namespace alluvium
{
  /** A file that this process has read, and the checksum of its content, where that is known. */
  struct InputFile
  {
    std::string path, digest;
  };

  /** Remember that this process has read @p path: what it writes must not take its place. */
  void note_input(const std::string &path, const std::string &digest = "");

  /** What note_input() was told, in that order, each path once. */
  const std::vector<InputFile> &noted_inputs();

  /** Checksum of a file's @p content. */
  std::string digest_of(const std::string &content);

  /** The same of the file at @p path, or empty if it cannot be read. */
  std::string digest_of_file(const std::string &path);
} // namespace alluvium
