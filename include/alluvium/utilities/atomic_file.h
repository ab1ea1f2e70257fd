#pragma once

#include <mpi.h>

#include <string>

namespace alluvium
{
  /**
   * Write @p content to a temporary file beside @p file_name and rename it: whoever reads, even after a crash, finds
   * the old file or the new one, whole. Throws a UserError if the disk does not take it.
   */
  void write_atomically(const std::string &file_name, const std::string &content);

  /** The same on rank 0, which alone needs @p content; a UserError reaches all ranks. Collective. */
  void write_atomically(MPI_Comm communicator, const std::string &file_name, const std::string &content);

  /**
   * One file of the pieces of all ranks, in their order, between @p head and @p tail, which rank 0 and the last rank
   * write; appears as a whole or not at all. Throws UserError on all ranks if the disk does not take it: MPI-IO would
   * leave a file that is cut off. Collective.
   */
  void write_in_order(MPI_Comm           communicator,
                      const std::string &file_name,
                      const std::string &head,
                      const std::string &piece,
                      const std::string &tail);

  /**
   * Throws UserError, naming @p file_name, unless its folder takes @p bytes more: for files that a library writes and
   * that would kill the program on a full disk. Rank 0 tries, with a file that it takes away again. Collective.
   */
  void check_room(MPI_Comm communicator, const std::string &file_name, double bytes);
} // namespace alluvium
