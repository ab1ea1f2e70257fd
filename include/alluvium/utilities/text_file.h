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

  /** Blanks of other kinds (no-break, thin, of no width), which come with text from web pages, as ordinary ones. */
  std::string with_plain_blanks(std::string text);

  /**
   * For the end of a message about @p text: that a dash or a quotation mark in it only looks like one that is meant, or
   * empty.
   */
  std::string look_alikes_in(const std::string &text);

  /**
   * The text of @p file, with line ends as '\n' and without byte order mark. Throws UserError, naming it as
   * "<what> '<file>'", if it does not exist, is a folder, cannot be read or is no text.
   */
  std::string read_text_file(const std::string &file, const std::string &what);
} // namespace alluvium
