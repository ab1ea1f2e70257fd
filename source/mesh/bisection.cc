#include <alluvium/mesh/bisection.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <vector>

namespace alluvium::mesh
{
  using namespace dealii;

  namespace
  {
    /** Cut cells [begin, end) into parts first_part ... first_part + n_parts - 1 by their centres, halving the longer
     * side. */
    template <int dim>
    void bisect(const std::vector<Point<dim>>        &centers,
                const std::vector<unsigned>::iterator begin,
                const std::vector<unsigned>::iterator end,
                const unsigned int                    first_part,
                const unsigned int                    n_parts,
                std::vector<types::subdomain_id>     &part)
    {
      if (n_parts == 1)
        {
          std::for_each(begin, end, [&](const unsigned int i) { part[i] = first_part; });
          return;
        }
      unsigned int axis    = 0;
      double       longest = -1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const auto [a, b] = std::minmax_element(
            begin, end, [&](const unsigned int i, const unsigned int j) { return centers[i][d] < centers[j][d]; });
          if (begin != end && centers[*b][d] - centers[*a][d] > longest)
            {
              longest = centers[*b][d] - centers[*a][d];
              axis    = d;
            }
        }
      const unsigned int low    = n_parts / 2;
      const auto         middle = begin + (end - begin) * std::size_t(low) / n_parts;
      std::nth_element(begin, middle, end, [&](const unsigned int i, const unsigned int j) {
        return centers[i][axis] != centers[j][axis] ? centers[i][axis] < centers[j][axis] : i < j;
      });
      bisect(centers, begin, middle, first_part, low, part);
      bisect(centers, middle, end, first_part + low, n_parts - low, part);
    }
  } // namespace


  template <int dim>
  void partition_by_bisection(parallel::shared::Triangulation<dim> &triangulation)
  {
    std::vector<Point<dim>>   centers;
    std::vector<unsigned int> order;
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        order.push_back(centers.size());
        centers.push_back(cell->center());
      }
    std::vector<types::subdomain_id> part(centers.size(), 0);
    bisect(
      centers, order.begin(), order.end(), 0, Utilities::MPI::n_mpi_processes(triangulation.get_communicator()), part);
    std::size_t i = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      cell->set_subdomain_id(part[i++]);
  }


  template void partition_by_bisection<2>(parallel::shared::Triangulation<2> &);
} // namespace alluvium::mesh
