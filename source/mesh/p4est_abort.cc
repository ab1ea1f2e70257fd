#include <alluvium/mesh/p4est_abort.h>
#include <alluvium/utilities/failure.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include <sc.h>

namespace alluvium::mesh
{
  namespace
  {
    // libsc's handler gets no arguments
    MPI_Comm    ranks = MPI_COMM_NULL;
    std::string complaint_now;

    /** Exceptions cannot pass through p4est's C. */
    void end_with_complaint()
    {
      int rank = 0, n_ranks = 1;
      MPI_Comm_rank(ranks, &rank);
      MPI_Comm_size(ranks, &n_ranks);
      if (rank > 0) // the first one prints, if it has failed, too
        std::this_thread::sleep_for(std::chrono::seconds(2));
      std::cerr << "alluvium: error: " << complaint_now << std::endl;
      if (n_ranks > 1)
        MPI_Abort(ranks, mistake_of_user);
      std::_Exit(mistake_of_user);
    }
  } // namespace


  P4estAbort::P4estAbort(const MPI_Comm communicator, const std::string &complaint)
  {
    ranks         = communicator;
    complaint_now = complaint;
    sc_set_abort_handler(&end_with_complaint);
  }


  P4estAbort::~P4estAbort()
  {
    sc_set_abort_handler(nullptr);
  }
} // namespace alluvium::mesh
