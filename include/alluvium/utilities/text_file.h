#pragma once

#include <string>

namespace alluvium
{
  /**
   * Take the byte order mark that Excel and Notepad put before UTF-8 away from the beginning of @p text. Throws
   * UserError, beginning with @p what, if the mark is that of UTF-16, which nothing here reads.
   */
  void strip_byte_order_mark(std::string &text, const std::string &what);

  /** Whether @p text is UTF-8, as everything that is written again must be. */
  bool is_utf8(const std::string &text);

  /**
   * The text of @p file, with line ends as '\n' and without byte order mark. Throws UserError, naming it as
   * "<what> '<file>'", if it does not exist, is a folder, cannot be read or is no text.
   */
  std::string read_text_file(const std::string &file, const std::string &what);
} // namespace alluvium
