#pragma once

#include <mpi.h>

#include <string>

namespace alluvium::mesh
{
  /**
   * p4est knows no errors: where it cannot read or write it calls abort(). While this lives, the program ends instead
   * with exit code 1 and @p complaint as its message, on all ranks of @p communicator. One at a time.
   */
  class P4estAbort
  {
  public:
    P4estAbort(MPI_Comm communicator, const std::string &complaint);
    ~P4estAbort();
    P4estAbort(const P4estAbort &)            = delete;
    P4estAbort &operator=(const P4estAbort &) = delete;
  };
} // namespace alluvium::mesh
