#include <alluvium/fluid/cell_order.h>
#include <alluvium/observers/line_average.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <limits>

namespace alluvium::observers
{
  using namespace dealii;

  namespace
  {
    /** Where edge a-b crosses the line on which coordinate axis is y, as the weight of b; false if it does not. */
    template <int dim>
    bool crossing(const Point<dim> &a, const Point<dim> &b, const unsigned int axis, const double y, double &weight)
    {
      if ((a[axis] <= y) == (b[axis] <= y))
        return false;
      weight = (y - a[axis]) / (b[axis] - a[axis]);
      return true;
    }
  } // namespace


  template <int dim>
  double line_average(const fluid::FluidSpace<dim>                                                  &space,
                      const fluid::BlockVector                                                      &solution,
                      const double                                                                   y_wanted,
                      const std::function<double(const std::array<double, dim> &u, const double p)> &function,
                      const unsigned int                                                             axis)
  {
    const unsigned int across = 1 - axis;
    const unsigned int n      = space.n_nodes_per_cell();
    double             top = -std::numeric_limits<double>::infinity(), bottom = -top;
    for (const auto &cell : space.cells())
      for (unsigned int v = 0; v < n; ++v)
        {
          top    = std::max(top, cell.vertex[v][axis]);
          bottom = std::min(bottom, cell.vertex[v][axis]);
        }
    top    = Utilities::MPI::max(top, space.communicator());
    bottom = Utilities::MPI::min(bottom, space.communicator());
    // a hair inside, so that the boundary's own lines belong to a cell
    const double y = std::min(std::max(y_wanted, bottom + 1e-9 * (top - bottom)), top - 1e-9 * (top - bottom));

    const std::array<std::pair<unsigned int, unsigned int>, 4> quad   = {{{0, 1}, {1, 3}, {3, 2}, {2, 0}}};
    const std::array<std::pair<unsigned int, unsigned int>, 4> tri    = {{{0, 1}, {1, 2}, {2, 0}, {0, 0}}};
    double                                                     sum[2] = {0., 0.};
    for (const auto &cell : space.cells())
      {
        // the line enters and leaves a convex cell through two edges; fields are linear along them
        std::array<double, dim> u{};
        double                  p = 0., x[2] = {0., 0.};
        unsigned int            n_crossings = 0;
        for (unsigned int e = 0; e < (n == 4 ? 4 : 3); ++e)
          {
            const auto [a, b] = n == 4 ? quad[e] : tri[e];
            double weight;
            if (n_crossings < 2 && crossing(cell.vertex[a], cell.vertex[b], axis, y, weight))
              {
                x[n_crossings++] = cell.vertex[a][across] + weight * (cell.vertex[b][across] - cell.vertex[a][across]);
                for (const auto &[v, w] : {std::make_pair(a, 1. - weight), std::make_pair(b, weight)})
                  {
                    p += 0.5 * w * solution.block(1).local_element(cell.pressure[v]);
                    for (unsigned int d = 0; d < dim; ++d)
                      u[d] += 0.5 * w * solution.block(0).local_element(cell.velocity[v][d]);
                  }
              }
          }
        if (n_crossings == 2)
          {
            const double width = std::abs(x[1] - x[0]);
            sum[0] += width * function(u, p);
            sum[1] += width;
          }
      }
    Utilities::MPI::sum(ArrayView<const double>(sum, 2), space.communicator(), ArrayView<double>(sum, 2));
    return sum[0] / sum[1];
  }


  template <int dim>
  double boundary_average(const fluid::FluidSpace<dim>                                                  &space,
                          const fluid::BlockVector                                                      &solution,
                          const types::boundary_id                                                       id,
                          const std::function<double(const std::array<double, dim> &u, const double p)> &function)
  {
    double     sum[2] = {0., 0.};
    const auto add    = [&](const unsigned int i, const unsigned int v, const double weight) {
      const auto             &cell = space.cells()[i];
      std::array<double, dim> u;
      for (unsigned int d = 0; d < dim; ++d)
        u[d] = solution.block(0).local_element(cell.velocity[v][d]);
      sum[0] += weight * function(u, solution.block(1).local_element(cell.pressure[v]));
      sum[1] += weight;
    };
    unsigned int index = 0;
    for (const auto &cell : fluid::ordered_cells(space.dof_handler()))
      if (cell->is_locally_owned())
        {
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == id)
              for (unsigned int e = 0; e < 2; ++e)
                for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
                  if (cell->face(f)->vertex_index(e) == cell->vertex_index(v))
                    add(index, v, 0.5 * cell->face(f)->measure());
          ++index;
        }
    if (Utilities::MPI::sum(sum[1], space.communicator()) == 0.) // a part of a side, known by its nodes only
      for (const auto &[i, weight] : space.boundary().weights_at(id))
        for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
          if (weight[v] > 0.)
            add(i, v, weight[v]);
    Utilities::MPI::sum(ArrayView<const double>(sum, 2), space.communicator(), ArrayView<double>(sum, 2));
    return sum[0] / sum[1];
  }


  template double boundary_average<2>(const fluid::FluidSpace<2> &,
                                      const fluid::BlockVector &,
                                      const types::boundary_id,
                                      const std::function<double(const std::array<double, 2> &, const double)> &);
  template double line_average<2>(const fluid::FluidSpace<2> &,
                                  const fluid::BlockVector &,
                                  const double,
                                  const std::function<double(const std::array<double, 2> &, const double)> &,
                                  const unsigned int);
} // namespace alluvium::observers
