#pragma once

#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>

#include <exception>
#include <string>

namespace alluvium
{
  inline bool is_first_rank(const MPI_Comm communicator)
  {
    return dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  }

  /** Call @p function on rank 0, for what is done with files; what it throws becomes a UserError on all. Collective. */
  template <typename Function>
  void on_first_rank(const MPI_Comm communicator, const Function &function)
  {
    std::string complaint;
    if (is_first_rank(communicator))
      try
        {
          function();
        }
      catch (const std::exception &error)
        {
          complaint = error.what();
        }
    complaint = dealii::Utilities::MPI::broadcast(communicator, complaint);
    check_user(complaint.empty(), complaint);
  }
} // namespace alluvium
