#include <alluvium/utilities/folder_lock.h>

#include <cerrno>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace alluvium
{
  namespace
  {
    std::string lock_file(const std::string &folder)
    {
      return folder + "/in-use";
    }

    std::string described(const std::string &file_name)
    {
      std::ifstream in(file_name);
      std::string   text;
      std::getline(in, text);
      return text.empty() ? "another process" : text;
    }

    std::string myself()
    {
      char host[256] = "";
      gethostname(host, sizeof(host) - 1);
      const std::time_t  now = std::time(nullptr);
      std::ostringstream text;
      text << "process " << getpid() << " on " << host << ", since "
           << std::put_time(std::localtime(&now), "%Y-%m-%d %H:%M:%S");
      return text.str();
    }

    /** Whether @p file_name is still the file that is open as @p file, and was not removed by who locked it before. */
    bool is_same(const int file, const std::string &file_name)
    {
      struct stat mine = {}, there = {};
      return fstat(file, &mine) == 0 && stat(file_name.c_str(), &there) == 0 && mine.st_ino == there.st_ino &&
             mine.st_dev == there.st_dev;
    }
  } // namespace


  FolderLock::FolderLock(const std::string &folder)
    : file_name(lock_file(folder))
  {
    constexpr unsigned int n_tries = 5; // somebody may only be looking
    for (unsigned int attempt = 1;; ++attempt)
      {
        file = open(file_name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0) // what is written next will say why
          return;
        if (flock(file, LOCK_EX | LOCK_NB) != 0)
          {
            const bool taken = errno == EWOULDBLOCK;
            close(file);
            file = -1;
            if (taken && attempt < n_tries)
              {
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                continue;
              }
            if (taken)
              holder = described(file_name);
            return;
          }
        if (is_same(file, file_name))
          break;
        close(file);
      }
    const std::string text = myself() + "\n";
    if (ftruncate(file, 0) != 0 || write(file, text.data(), text.size()) < 0)
      return; // the lock holds without a name
  }


  FolderLock::~FolderLock()
  {
    if (file < 0)
      return;
    if (is_same(file, file_name))
      unlink(file_name.c_str()); // before the lock ends: who waits for it sees that the file has gone
    close(file);
  }


  std::string FolderLock::holder_of(const std::string &folder)
  {
    const std::string file_name = lock_file(folder);
    const int         file      = open(file_name.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
      return "";
    const bool taken = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    close(file);
    return taken ? described(file_name) : "";
  }
} // namespace alluvium
