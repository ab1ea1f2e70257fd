#include <alluvium/coupling/solid_excess.h>
#include <alluvium/coupling/void_fraction.h>

#include <algorithm>

namespace alluvium::coupling
{
  using namespace dealii;

  double
  lumped_void_fraction(const fluid::InterphaseTerms<2> &pieces, const fluid::FluidSpace<2> &space, fluid::Vector &eps)
  {
    const unsigned int n       = space.n_nodes_per_cell();
    const auto        &volumes = space.node_volumes();
    fluid::Vector      solid   = space.make_nodal_field();

    // with ghosts: row indices of the constraints are global, those of the cells local
    std::vector<types::global_dof_index> nodes(n);
    dealii::Vector<double>               local(n);
    const auto                          &partitioner = *solid.get_partitioner();
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      {
        if (pieces.begin[c] == pieces.begin[c + 1])
          continue;
        local = 0.;
        for (unsigned int k = pieces.begin[c]; k < pieces.begin[c + 1]; ++k)
          for (unsigned int v = 0; v < n; ++v)
            local(v) += pieces.shape[k].area * pieces.shape[k].phi[v];
        for (unsigned int v = 0; v < n; ++v)
          nodes[v] = partitioner.local_to_global(space.cells()[c].node[v]);
        space.nodal_constraints().distribute_local_to_global(local, nodes, solid);
      }
    solid.compress(VectorOperation::add);

    const double moved = spread_excess(space, solid);

    eps.zero_out_ghost_values();
    for (unsigned int i = 0; i < eps.locally_owned_size(); ++i)
      eps.local_element(i) =
        volumes.local_element(i) > 0. ? std::max(0., 1. - solid.local_element(i) / volumes.local_element(i)) : 1.;
    space.interpolate_hanging_nodes(eps);
    return moved;
  }
} // namespace alluvium::coupling
