#include <alluvium/fluid/largest_speed.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace alluvium::fluid
{
  double largest_speed(const FluidSpace<2> &space, const Vector &velocity)
  {
    double square = 0.;
    for (const auto &cell : space.cells())
      for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
        {
          const double ux = velocity.local_element(cell.velocity[v][0]),
                       uy = velocity.local_element(cell.velocity[v][1]);
          square          = std::max(square, ux * ux + uy * uy);
        }
    return std::sqrt(dealii::Utilities::MPI::max(square, space.communicator()));
  }
} // namespace alluvium::fluid
