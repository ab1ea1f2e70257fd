#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace alluvium
{
  void strip_byte_order_mark(std::string &text, const std::string &what)
  {
    const auto begins_with = [&](const char *const mark) { return text.compare(0, std::strlen(mark), mark) == 0; };
    check_user(!begins_with("\xFF\xFE") && !begins_with("\xFE\xFF"),
               what + " is saved as UTF-16 ('Unicode'); save it as UTF-8 or plain text.");
    if (begins_with("\xEF\xBB\xBF"))
      text.erase(0, 3);
  }


  bool is_utf8(const std::string &text)
  {
    const auto byte = [&](const std::size_t i) { return static_cast<unsigned char>(text[i]); };
    for (std::size_t i = 0; i < text.size();)
      {
        const unsigned int first = byte(i);
        const std::size_t  more  = first < 0x80   ? 0
                                   : first < 0xC2 ? 4
                                   : first < 0xE0 ? 1
                                   : first < 0xF0 ? 2
                                   : first < 0xF5 ? 3
                                                  : 4;
        if (more == 4 || i + more >= text.size())
          return false;
        for (std::size_t k = 1; k <= more; ++k)
          if ((byte(i + k) & 0xC0) != 0x80)
            return false;
        // no longer than needed, no halves of UTF-16, none beyond the last plane
        if (more > 1 && ((first == 0xE0 && byte(i + 1) < 0xA0) || (first == 0xED && byte(i + 1) > 0x9F) ||
                         (first == 0xF0 && byte(i + 1) < 0x90) || (first == 0xF4 && byte(i + 1) > 0x8F)))
          return false;
        i += 1 + more;
      }
    return true;
  }


  std::string with_plain_blanks(std::string text)
  {
    for (const std::string blank :
         {"\xC2\xA0", "\xE2\x80\x82", "\xE2\x80\x83", "\xE2\x80\x87", "\xE2\x80\x89", "\xE2\x80\xAF"})
      for (auto at = text.find(blank); at != std::string::npos; at = text.find(blank, at))
        text.replace(at, blank.size(), " ");
    for (const std::string nothing : {"\xE2\x80\x8B", "\xEF\xBB\xBF"})
      for (auto at = text.find(nothing); at != std::string::npos; at = text.find(nothing, at))
        text.erase(at, nothing.size());
    return text;
  }


  std::string look_alikes_in(const std::string &text)
  {
    for (const std::string dash : {"\xE2\x88\x92", "\xE2\x80\x90", "\xE2\x80\x91", "\xE2\x80\x93", "\xE2\x80\x94"})
      if (text.find(dash) != std::string::npos)
        return " The '" + dash + "' in it is another character than the minus sign '-'.";
    for (const std::string other : {"\xC3\x97", "\xC2\xB7"})
      if (text.find(other) != std::string::npos)
        return " The '" + other + "' in it is no operator; multiply with '*'.";
    return "";
  }


  std::string read_text_file(const std::string &file, const std::string &what)
  {
    const std::string named = what + " '" + file + "'";
    std::error_code   error;
    check_user(std::filesystem::exists(file, error), "There is no " + named + ".");
    check_user(!std::filesystem::is_directory(file, error), "The " + named + " is a folder.");
    errno = 0;
    std::ifstream      in(file, std::ios::binary);
    std::ostringstream all;
    check_user(in.good(), "Cannot open the " + named + ": " + std::strerror(errno) + ".");
    if (in.peek() != std::ifstream::traits_type::eof())
      all << in.rdbuf();
    check_user(!in.bad() && !all.fail(), "Cannot read the " + named + ".");
    std::string text = all.str();
    note_input(file, digest_of(text));
    strip_byte_order_mark(text, "The " + named);
    check_user(text.find('\0') == std::string::npos, "The " + named + " is no text: it holds zero bytes.");
    if (text.find('\n') == std::string::npos) // an old Macintosh's line ends
      for (char &c : text)
        if (c == '\r')
          c = '\n';
    return text;
  }
} // namespace alluvium
