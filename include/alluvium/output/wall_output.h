#pragma once

#include <alluvium/grains/wall.h>
#include <alluvium/output/field_series.h>

#include <mpi.h>

#include <vector>

namespace alluvium::output
{
  /** Write the @p walls that are present, with their velocities, as lines. Collective. */
  void
  write_walls(FieldSeries &series, const std::vector<grains::WallSegment> &walls, double time, MPI_Comm communicator);
} // namespace alluvium::output
