#pragma once

#include <deal.II/base/mpi.h>

namespace alluvium
{
  /**
   * MPI, and whatever deal.II starts with it, for as long as this lives: one thread a rank. BLAS too gets one, unless
   * the environment says otherwise: what the multigrid's coarsest grid gives it is small, and OpenBLAS's second thread
   * would spin on after each call, on a core that another rank needs.
   */
  class MpiEnvironment
  {
  public:
    MpiEnvironment(int &argc, char **&argv);

  private:
    dealii::Utilities::MPI::MPI_InitFinalize mpi;
  };
} // namespace alluvium
