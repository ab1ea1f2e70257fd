#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include <unistd.h>

namespace alluvium
{
  namespace
  {
    [[noreturn]] void fail(const std::string &file_name, const int error)
    {
      throw UserError("cannot write '" + file_name + "': " + std::strerror(error) + ".");
    }

    /** Write, with @p mode of fopen(), until the disk has it; returns errno or 0. */
    template <typename Put>
    int put_into(const std::string &file_name, const char *const mode, const Put &put)
    {
      errno           = 0;
      std::FILE *file = std::fopen(file_name.c_str(), mode);
      if (file == nullptr)
        return std::max(errno, 1);
      int error = 0;
      if (!put(file) || std::fflush(file) != 0 || fsync(fileno(file)) != 0)
        error = std::max(errno, 1);
      if (std::fclose(file) != 0 && error == 0)
        error = std::max(errno, 1);
      return error;
    }

    int put_text(const std::string &file_name, const char *const mode, const std::string &text)
    {
      return put_into(file_name, mode, [&](std::FILE *file) {
        return std::fwrite(text.data(), 1, text.size(), file) == text.size();
      });
    }

    int rename(const std::string &from, const std::string &to)
    {
      errno = 0;
      return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : std::max(errno, 1);
    }
  } // namespace


  void write_atomically(const std::string &file_name, const std::string &content)
  {
    const std::string temporary = file_name + ".tmp";
    int               error     = put_text(temporary, "w", content);
    if (error == 0)
      error = rename(temporary, file_name);
    if (error != 0)
      {
        std::remove(temporary.c_str());
        fail(file_name, error);
      }
  }


  void write_atomically(const MPI_Comm communicator, const std::string &file_name, const std::string &content)
  {
    write_in_order(communicator, file_name, content, "", "");
  }


  void write_in_order(const MPI_Comm     communicator,
                      const std::string &file_name,
                      const std::string &head,
                      const std::string &piece,
                      const std::string &tail)
  {
    int rank = 0, n_ranks = 1;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_ranks);
    const std::string temporary = file_name + ".tmp";
    // who has nothing to add is not waited for
    std::vector<char> adds(n_ranks);
    const char        mine = !piece.empty();
    MPI_Allgather(&mine, 1, MPI_CHAR, adds.data(), 1, MPI_CHAR, communicator);
    adds[0]      = 1;
    int previous = rank - 1, next = rank + 1;
    while (previous > 0 && !adds[previous])
      --previous;
    while (next < n_ranks && !adds[next])
      ++next;

    constexpr int tag   = 0;
    int           error = 0;
    if (rank > 0 && adds[rank])
      MPI_Recv(&error, 1, MPI_INT, previous, tag, communicator, MPI_STATUS_IGNORE);
    if (adds[rank])
      {
        if (error == 0)
          error = rank == 0 ? put_text(temporary, "w", head + piece + (next == n_ranks ? tail : ""))
                            : put_text(temporary, "a", piece + (next == n_ranks ? tail : ""));
        if (next < n_ranks)
          MPI_Send(&error, 1, MPI_INT, next, tag, communicator);
      }
    MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_INT, MPI_MAX, communicator);
    if (rank == 0)
      {
        if (error == 0)
          error = rename(temporary, file_name);
        if (error != 0)
          std::remove(temporary.c_str());
      }
    MPI_Bcast(&error, 1, MPI_INT, 0, communicator);
    if (error != 0)
      fail(file_name, error);
  }


  void check_room(const MPI_Comm communicator, const std::string &file_name, const double bytes)
  {
    int rank = 0, error = 0;
    MPI_Comm_rank(communicator, &rank);
    if (rank == 0)
      {
        const std::string trial = file_name + ".tmp";
        // written, not only promised: quotas and file systems that compress know no better way
        error = put_into(trial, "w", [&](std::FILE *file) {
          const std::vector<char> block(1 << 16, 1);
          for (double left = bytes; left > 0.; left -= block.size())
            {
              const auto n = static_cast<std::size_t>(std::min<double>(left, block.size()));
              if (std::fwrite(block.data(), 1, n, file) != n)
                return false;
            }
          return true;
        });
        std::remove(trial.c_str());
      }
    MPI_Bcast(&error, 1, MPI_INT, 0, communicator);
    if (error != 0)
      fail(file_name, error);
  }
} // namespace alluvium
