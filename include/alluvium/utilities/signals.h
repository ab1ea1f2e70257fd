#pragma once

#include <mpi.h>

#include <string>

namespace alluvium
{
  /**
   * From now on a SIGINT, SIGTERM or SIGUSR1 asks the run to stop after its present step instead of killing it. A
   * second one of the same kind kills, in case the step never ends; so does the first before this is called, as during
   * the set-up, where nothing is lost. (mpirun forwards SIGUSR1; of the others it gives a
   * second's grace only.)
   */
  void install_stop_signals();

  /** A file that may not grow is a write that fails, with a message, not SIGXFSZ, which kills. */
  void ignore_file_limit_signal();

  /** The signal by which any rank was asked to stop, or 0. Collective. */
  int stop_requested(MPI_Comm communicator);

  /** 'SIGTERM' and the like. */
  std::string signal_name(int signal);
} // namespace alluvium
