#pragma once

#include <mpi.h>

#include <exception>
#include <string>

namespace alluvium
{
  /** Exit codes of the program besides 0. */
  enum ExitCode
  {
    mistake_of_user = 1, // in parameters, files, the command line, or the disk is full
    program_failed  = 2, // the linear solver gave up, or a mistake of ours
    diverged        = 3
  };

  /** How an exception ends the program. */
  struct Failure
  {
    int         exit_code = program_failed;
    std::string message;
  };

  /** What @p exception comes to, in words for the user. */
  Failure describe_failure(const std::exception_ptr &exception);

  /**
   * Whether all ranks of @p communicator have come here with the same message, within a few seconds: then they may
   * still talk to each other. @p communicator must be used for nothing else. To be called by ranks that failed.
   */
  bool failed_together(MPI_Comm communicator, const std::string &message);
} // namespace alluvium
