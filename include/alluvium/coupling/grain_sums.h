#pragma once

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace alluvium::coupling
{
  /** Replace @p values by their sums over all ranks, the same bits on all of them. Collective. */
  void sum_over_ranks(std::vector<double> &values, MPI_Comm communicator);

  /** Sums over the pieces of each grain, its intersections with cells, a number of columns side by side, so that ranks
   * add all of them at once. */
  class GrainSums
  {
  public:
    GrainSums(const std::size_t n_grains, const unsigned int n_columns)
      : n_columns(n_columns)
      , values(n_grains * n_columns, 0.)
    {}

    /** The columns of grain @p g. */
    double       *of(const std::size_t g) { return values.data() + n_columns * g; }
    const double *of(const std::size_t g) const { return values.data() + n_columns * g; }

    /** Until here each rank has the sums over its own pieces. Collective. */
    void complete(MPI_Comm communicator) { sum_over_ranks(values, communicator); }

  private:
    unsigned int        n_columns;
    std::vector<double> values;
  };
} // namespace alluvium::coupling
