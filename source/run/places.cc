#include <alluvium/run/model.h>
#include <alluvium/run/places.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    /** The rank with the largest @p value; the first of several. Collective. */
    int rank_of_largest(const MPI_Comm communicator, const double value)
    {
      struct
      {
        double value;
        int    rank;
      } mine{value, static_cast<int>(Utilities::MPI::this_mpi_process(communicator))};
      MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE_INT, MPI_MAXLOC, communicator);
      return mine.rank;
    }

    double distance(const Point<2> &a, const Point<2> &b, const Point<2> &x)
    {
      const Tensor<1, 2> ab = b - a;
      const double       s  = std::clamp(((x - a) * ab) / (ab * ab), 0., 1.);
      return (x - a - s * ab).norm();
    }
  } // namespace


  Place fastest_fluid(const Model &m)
  {
    const auto           &u = m.solver.solution().block(0), &p = m.solver.solution().block(1);
    const auto           &eps     = m.coupling.void_fraction();
    double                fastest = -1.;
    std::array<double, 2> point{};
    for (const auto &cell : m.space.cells())
      for (unsigned int v = 0; v < m.space.n_nodes_per_cell(); ++v)
        {
          const double ux = u.local_element(cell.velocity[v][0]), uy = u.local_element(cell.velocity[v][1]);
          double       square = ux * ux + uy * uy;
          if (!std::isfinite(square + p.local_element(cell.pressure[v]) + eps.local_element(cell.node[v])))
            square = std::numeric_limits<double>::max();
          if (square > fastest)
            {
              fastest = square;
              point   = {{cell.vertex[v][0], cell.vertex[v][1]}};
            }
        }
    MPI_Bcast(point.data(), 2, MPI_DOUBLE, rank_of_largest(m.communicator, fastest), m.communicator);
    return {point, nearest_boundary(m, point)};
  }


  Place fastest_grain(const Model &m)
  {
    const auto &g       = m.grains;
    double      fastest = -1.;
    std::size_t k       = 0;
    for (std::size_t i = 0; i < g.n(); ++i)
      {
        double square = g.velocity[0][i] * g.velocity[0][i] + g.velocity[1][i] * g.velocity[1][i];
        if (!std::isfinite(square + g.position[0][i] + g.position[1][i]))
          square = std::numeric_limits<double>::max();
        if (square > fastest)
          {
            fastest = square;
            k       = i;
          }
      }
    if (g.n() == 0)
      return {};
    return {{{g.position[0][k], g.position[1][k]}}, "grain " + std::to_string(g.id[k])};
  }


  std::string nearest_boundary(const Model &m, const std::array<double, 2> &point)
  {
    const Point<2>     x(point[0], point[1]);
    double             nearest = std::numeric_limits<double>::max();
    types::boundary_id id      = 0;
    if (m.triangulation)
      for (const auto &cell : m.triangulation->active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              {
                const double d = distance(cell->face(f)->vertex(0), cell->face(f)->vertex(1), x);
                if (d < nearest)
                  {
                    nearest = d;
                    id      = cell->face(f)->boundary_id();
                  }
              }
    const int    rank    = rank_of_largest(m.communicator, -nearest);
    unsigned int found[] = {id};
    MPI_Bcast(found, 1, MPI_UNSIGNED, rank, m.communicator);
    MPI_Bcast(&nearest, 1, MPI_DOUBLE, rank, m.communicator);
    for (const auto &part : m.domain.parts())
      if (part.side == found[0] && point[part.axis] > part.low && point[part.axis] < part.high)
        found[0] = part.id;
    for (const auto &[name, number] : m.domain.boundary_ids())
      if (number == found[0] && nearest < std::numeric_limits<double>::max())
        {
          std::ostringstream text;
          text << "the boundary '" << name << "', " << nearest << " m away";
          return text.str();
        }
    return "";
  }
} // namespace alluvium::run
