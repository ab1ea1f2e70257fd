#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/user_error.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <unistd.h>

namespace alluvium
{
  void write_atomically(const std::string &file_name, const std::string &content)
  {
    const std::string temporary = file_name + ".tmp";
    const auto        fail      = [&] {
      const std::string reason = std::strerror(errno);
      std::remove(temporary.c_str());
      throw UserError("cannot write '" + file_name + "': " + reason + ".");
    };

    std::FILE *file = std::fopen(temporary.c_str(), "w");
    if (file == nullptr)
      fail();
    const bool is_written = std::fwrite(content.data(), 1, content.size(), file) == content.size() &&
                            std::fflush(file) == 0 && fsync(fileno(file)) == 0;
    if ((std::fclose(file) != 0) | !is_written)
      fail();
    if (std::rename(temporary.c_str(), file_name.c_str()) != 0)
      fail();
  }
} // namespace alluvium
