#pragma once

#include <alluvium/deposits/deposit.h>

#include <string>
#include <vector>

namespace alluvium::deposits
{
  /**
   * Read grains from a CSV file whose header names its columns: x, y, radius, and if wanted density, vx, vy, omega, in
   * any order, SI units. Empty lines and lines that begin with # are skipped, and a byte order mark. Without a density
   * column all grains get @p density. Throws UserError, with file and line, for anything that is not such a table.
   */
  std::vector<NewGrain> read_grain_table(const std::string &file, double density);

  /** The same from the @p text of a file. */
  std::vector<NewGrain> parse_grain_table(const std::string &text, const std::string &file, double density);

  /** The table of @p new_grains, from which parse_grain_table() makes the same bits. */
  std::string grain_table(const std::vector<NewGrain> &new_grains);

  /** Write @p new_grains such that read_grain_table() gives back the same bits. The file appears complete or not at
   * all. */
  void write_grain_table(const std::string &file, const std::vector<NewGrain> &new_grains, const std::string &comment);

  /** @p file as seen from @p directory, unless it is an absolute path. */
  std::string path_from(const std::string &directory, const std::string &file);
} // namespace alluvium::deposits
