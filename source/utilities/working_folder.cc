#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/working_folder.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace alluvium
{
  WorkingFolder::WorkingFolder(const std::string &folder)
    : before(open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC))
  {
    const bool is_there = before >= 0 && chdir(folder.c_str()) == 0;
    if (is_there)
      return;
    const int error = errno;
    if (before >= 0)
      close(before);
    throw UserError("cannot work in the folder '" + folder + "': " + std::strerror(error) + ".");
  }


  WorkingFolder::~WorkingFolder()
  {
    if (fchdir(before) != 0)
      {} // the folder has gone; nothing relative can be found any more
    close(before);
  }
} // namespace alluvium
