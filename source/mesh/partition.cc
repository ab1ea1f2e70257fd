#include <alluvium/mesh/partition.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace alluvium::mesh
{
  using namespace dealii;

  namespace
  {
    using Forest = parallel::distributed::Triangulation<2>;

    /** The id of the last cell that this rank owns in the order of p4est's forest; empty if it owns none. */
    std::string last_cell(const Forest &mesh)
    {
      using Cell = Triangulation<2>::cell_iterator;
      Cell              last;
      bool              found = false;
      std::vector<Cell> stack;
      for (const auto index : mesh.get_p4est_tree_to_coarse_cell_permutation())
        for (stack.assign(1, Cell(&mesh, 0, index)); !stack.empty();)
          {
            const Cell cell = stack.back();
            stack.pop_back();
            if (!cell->is_active())
              for (unsigned int c = cell->n_children(); c > 0; --c)
                stack.push_back(cell->child(c - 1));
            else if (cell->is_active() && Triangulation<2>::active_cell_iterator(cell)->is_locally_owned())
              {
                last  = cell;
                found = true;
              }
          }
      return found ? last->id().to_string() : std::string();
    }
  } // namespace


  Partition Partition::of(const Triangulation<2> &mesh)
  {
    Partition result;
    result.n_ranks = Utilities::MPI::n_mpi_processes(mesh.get_communicator());
    if (const auto *forest = dynamic_cast<const Forest *>(&mesh))
      {
        for (const auto &id : Utilities::MPI::all_gather(mesh.get_communicator(), last_cell(*forest)))
          if (!id.empty())
            result.last_cells.push_back(id);
      }
    else if (const auto *shared = dynamic_cast<const parallel::shared::Triangulation<2> *>(&mesh))
      result.owners = shared->get_true_subdomain_ids_of_cells();
    return result;
  }


  void Partition::apply(Triangulation<2> &mesh) const
  {
    auto *forest = dynamic_cast<Forest *>(&mesh);
    if (!forest)
      return;
    // p4est cuts where the sum of the weights before a cell reaches a rank's share: one for each rank's last cell
    const std::set<std::string> last(last_cells.begin(), last_cells.end());
    const auto                  connection =
      mesh.signals.weight.connect([&](const Triangulation<2>::cell_iterator &cell, const auto) -> unsigned int {
        return last.count(cell->id().to_string());
      });
    forest->repartition();
    connection.disconnect();
  }


  void Partition::save(ByteWriter &writer) const
  {
    writer.put(n_ranks);
    writer.put(owners);
    writer.put<std::uint64_t>(last_cells.size());
    for (const auto &id : last_cells)
      writer.put(id);
  }


  void Partition::load(ByteReader &reader)
  {
    n_ranks = reader.get<unsigned int>();
    owners  = reader.get_vector<types::subdomain_id>();
    if (std::any_of(owners.begin(), owners.end(), [&](const auto owner) { return owner >= n_ranks; }))
      throw std::runtime_error("A cell belongs to no rank.");
    last_cells.clear();
    for (auto n = reader.get<std::uint64_t>(); n > 0; --n)
      last_cells.push_back(reader.get_string());
  }
} // namespace alluvium::mesh
