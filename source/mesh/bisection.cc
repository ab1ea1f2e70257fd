#include <alluvium/mesh/bisection.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace alluvium::mesh
{
  using namespace dealii;

  namespace
  {
    using Indices = std::vector<unsigned int>::iterator;

    struct Cut
    {
      unsigned int axis    = 0;
      std::size_t  n_below = 0;                                       // cells
      double       cost    = std::numeric_limits<double>::infinity(); // of the dearest part
    };

    class Bisection
    {
    public:
      Bisection(const std::vector<BisectedCell> &cells)
        : part(cells.size())
        , cells(cells)
      {}

      /** Assign the cells [begin, end) to parts first_part ... first_part + n_parts - 1. */
      void deal(const Indices begin, const Indices end, const unsigned int first_part, const unsigned int n_parts)
      {
        if (n_parts == 1)
          {
            std::for_each(begin, end, [&](const unsigned int i) { part[i] = first_part; });
            return;
          }
        const std::array<unsigned int, 2> halves{{n_parts / 2, n_parts - n_parts / 2}};
        const unsigned int                longer = length(begin, end, 1) > length(begin, end, 0) ? 1 : 0;

        constexpr double about_as_good = 1.02;
        Cut              best          = best_cut(begin, end, longer, halves);
        if (const Cut other = best_cut(begin, end, 1 - longer, halves); about_as_good * other.cost < best.cost)
          best = other;

        sort_along(best.axis, begin, end);
        const Indices middle = begin + best.n_below;
        deal(begin, middle, first_part, halves[0]);
        deal(middle, end, first_part + halves[0], halves[1]);
      }

      std::vector<types::subdomain_id> part;

    private:
      double length(const Indices begin, const Indices end, const unsigned int axis) const
      {
        if (begin == end)
          return 0.;
        const auto [low, high] = std::minmax_element(
          begin, end, [&](const auto i, const auto j) { return cells[i].center[axis] < cells[j].center[axis]; });
        return cells[*high].center[axis] - cells[*low].center[axis];
      }

      void sort_along(const unsigned int axis, const Indices begin, const Indices end) const
      {
        std::sort(begin, end, [&](const unsigned int i, const unsigned int j) {
          const double a = cells[i].center[axis], b = cells[j].center[axis];
          return a != b ? a < b : i < j;
        });
      }

      /** Where to cut [begin, end), which it sorts, into two halves of that many parts each. */
      Cut best_cut(const Indices                      begin,
                   const Indices                      end,
                   const unsigned int                 axis,
                   const std::array<unsigned int, 2> &n_parts) const
      {
        sort_along(axis, begin, end);
        double n_near = 0., n_near_below = 0.;
        std::for_each(begin, end, [&](const unsigned int i) { n_near += cells[i].n_near; });
        const std::size_t n = end - begin;
        Cut               best{axis, n * n_parts[0] / (n_parts[0] + n_parts[1])};
        for (std::size_t m = 1; m < n; ++m)
          {
            n_near_below += cells[begin[m - 1]].n_near;
            const double cost =
              CellWeights::cost(std::max(double(m) / n_parts[0], double(n - m) / n_parts[1]),
                                std::max(n_near_below / n_parts[0], (n_near - n_near_below) / n_parts[1]));
            if (m >= n_parts[0] && n - m >= n_parts[1] && cost < best.cost)
              best = {axis, m, cost};
          }
        return best;
      }

      const std::vector<BisectedCell> &cells;
    };
  } // namespace


  std::vector<types::subdomain_id> bisect(const std::vector<BisectedCell> &cells, const unsigned int n_parts)
  {
    std::vector<unsigned int> order(cells.size());
    std::iota(order.begin(), order.end(), 0u);
    Bisection bisection(cells);
    bisection.deal(order.begin(), order.end(), 0, n_parts);
    return bisection.part;
  }


  void partition_by_bisection(parallel::shared::Triangulation<2> &triangulation, const CellWeights &weights)
  {
    std::vector<BisectedCell> cells;
    for (const auto &cell : triangulation.active_cell_iterators())
      cells.push_back({cell->center(), weights.n_near(box_of(cell))});
    const auto  part = bisect(cells, Utilities::MPI::n_mpi_processes(triangulation.get_communicator()));
    std::size_t i    = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      cell->set_subdomain_id(part[i++]);
  }
} // namespace alluvium::mesh
