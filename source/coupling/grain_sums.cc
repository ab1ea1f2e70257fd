#include <alluvium/coupling/grain_sums.h>

#include <deal.II/base/mpi.h>

namespace alluvium::coupling
{
  void sum_over_ranks(std::vector<double> &values, MPI_Comm communicator)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;
    // reduced on one rank and sent to all: replicated contact solves must start from the same bits
    std::vector<double> sum(values.size());
    MPI_Reduce(values.data(), sum.data(), values.size(), MPI_DOUBLE, MPI_SUM, 0, communicator);
    MPI_Bcast(sum.data(), sum.size(), MPI_DOUBLE, 0, communicator);
    values.swap(sum);
  }
} // namespace alluvium::coupling
