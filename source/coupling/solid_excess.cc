#include <alluvium/coupling/solid_excess.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alluvium::coupling
{
  using namespace dealii;

  double spread_excess(const fluid::FluidSpace<2> &space, fluid::Vector &solid)
  {
    constexpr unsigned int max_passes = 200; // few are needed but in crowds
    const unsigned int     n          = space.n_nodes_per_cell();
    const auto            &volumes    = space.node_volumes();
    double                 moved      = 0.;
    for (unsigned int pass = 0; pass < max_passes; ++pass)
      {
        fluid::Vector excess = space.make_nodal_field(), room = space.make_nodal_field(),
                      share = space.make_nodal_field();
        double total        = 0.;
        for (unsigned int i = 0; i < solid.locally_owned_size(); ++i)
          {
            const double over       = solid.local_element(i) - volumes.local_element(i);
            const bool   hanging    = volumes.local_element(i) == 0.;
            excess.local_element(i) = hanging ? 0. : std::max(0., over);
            // a little also for full nodes, which hand it on: excess must get out of a crowd
            room.local_element(i) = hanging ? 0. : std::max(0., -over) + 1e-2 * volumes.local_element(i);
            if (over > 1e-13 * volumes.local_element(i))
              total += excess.local_element(i);
          }
        total = Utilities::MPI::sum(total, space.communicator());
        if (total == 0.)
          break;
        if (pass == 0)
          moved = total;
        excess.update_ghost_values();
        room.update_ghost_values();
        // room around each node, then its excess in shares of that
        fluid::Vector around = space.make_nodal_field();
        for (int stage = 0; stage < 2; ++stage)
          {
            fluid::Vector &target = stage == 0 ? around : share;
            for (const auto &cell : space.cells())
              {
                double in_cell = 0.;
                for (unsigned int v = 0; v < n; ++v)
                  in_cell += room.local_element(cell.node[v]);
                for (unsigned int v = 0; v < n; ++v)
                  if (excess.local_element(cell.node[v]) > 0.)
                    {
                      if (stage == 0)
                        target.local_element(cell.node[v]) += in_cell;
                      else if (around.local_element(cell.node[v]) > 0.)
                        for (unsigned int w = 0; w < n; ++w)
                          target.local_element(cell.node[w]) += excess.local_element(cell.node[v]) *
                                                                room.local_element(cell.node[w]) /
                                                                around.local_element(cell.node[v]);
                    }
              }
            target.compress(VectorOperation::add);
            target.update_ghost_values();
          }
        for (unsigned int i = 0; i < solid.locally_owned_size(); ++i)
          if (around.local_element(i) > 0. || excess.local_element(i) == 0.)
            solid.local_element(i) += share.local_element(i) - excess.local_element(i);
      }
    return moved;
  }
} // namespace alluvium::coupling
