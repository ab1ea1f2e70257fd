#pragma once

#include <mpi.h>

#include <string>

namespace alluvium
{
  /**
   * From now on a SIGINT, SIGTERM or SIGUSR1 asks the run to stop after its present step instead of killing it. A
   * second one of the same kind kills, in case the step never ends. (mpirun forwards SIGUSR1; of the others it gives a
   * second's grace only.)
   */
  void install_stop_signals();

  /** The signal by which any rank was asked to stop, or 0. Collective. */
  int stop_requested(MPI_Comm communicator);

  /** 'SIGTERM' and the like. */
  std::string signal_name(int signal);
} // namespace alluvium
