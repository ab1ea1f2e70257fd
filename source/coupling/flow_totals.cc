#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/flow_totals.h>
#include <alluvium/fluid/piece_gradients.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace alluvium::coupling
{
  using namespace dealii;

  namespace
  {
    /** The sums of this rank, and the flux that leaves each node. */
    struct Sums
    {
      double                solid = 0., flux_square = 0.;
      std::array<double, 2> volume_flux{}; // integral of eps u [m^3/s]
      fluid::Vector         residual;
    };

    template <int n>
    void add_cells(const OverlapMap           &map,
                   const fluid::FluidSpace<2> &space,
                   const fluid::Vector        &void_fraction,
                   const fluid::Vector        &velocity,
                   const grains::GrainArrays  &grains,
                   Sums                       &sums)
    {
      const auto                          &terms       = map.terms();
      const auto                          &partitioner = *sums.residual.get_partitioner();
      std::vector<types::global_dof_index> nodes(n);
      dealii::Vector<double>               leaving(n);
      for (unsigned int c = 0; c < space.cells().size(); ++c)
        {
          const fluid::CellData<2> &cell = space.cells()[c];
          leaving                        = 0.;
          for (unsigned int q = 0; q < space.n_q_points(); ++q)
            {
              double                eps = 0.;
              std::array<double, 2> flux{};
              for (unsigned int v = 0; v < n; ++v)
                eps += space.shape_values()[q][v] * void_fraction.local_element(cell.node[v]);
              for (unsigned int d = 0; d < 2; ++d)
                {
                  for (unsigned int v = 0; v < n; ++v)
                    flux[d] += eps * space.shape_values()[q][v] * velocity.local_element(cell.velocity[v][d]);
                  sums.volume_flux[d] += flux[d] * cell.jxw[q];
                  sums.flux_square += flux[d] * flux[d] * cell.jxw[q];
                  for (unsigned int v = 0; v < n; ++v)
                    leaving(v) += flux[d] * cell.grad[q][v][d] * cell.jxw[q];
                }
              sums.solid += (1. - eps) * cell.jxw[q];
            }
          for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
            {
              const unsigned int g    = map.grain()[k];
              const auto         grad = fluid::piece_gradients<n>(cell, terms.shape[k].phi);
              for (unsigned int v = 0; v < n; ++v)
                leaving(v) +=
                  terms.shape[k].area * (grains.velocity[0][g] * grad[v][0] + grains.velocity[1][g] * grad[v][1]);
            }
          for (unsigned int v = 0; v < n; ++v)
            nodes[v] = partitioner.local_to_global(cell.node[v]);
          space.nodal_constraints().distribute_local_to_global(leaving, nodes, sums.residual);
        }
    }
  } // namespace


  FlowTotals flow_totals(const Coupling                     &coupling,
                         const fluid::FluidSpace<2>         &space,
                         const fluid::VansSolver<2>         &solver,
                         const fluid::BoundaryConditions<2> &boundary_conditions,
                         const grains::GrainArrays          &grains)
  {
    Sums sums;
    sums.residual    = space.make_nodal_field();
    const auto cells = space.n_nodes_per_cell() == 3 ? add_cells<3> : add_cells<4>;
    cells(coupling.overlap(), space, coupling.void_fraction(), solver.solution().block(0), grains, sums);
    sums.residual.compress(VectorOperation::add);

    // what leaves through a boundary is no residual
    for (const auto &boundary : boundary_conditions.all())
      for (const auto &[c, weight] : space.boundary().weights_at(boundary.first))
        for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
          if (const unsigned int node = space.cells()[c].node[v];
              weight[v] > 0. && node < sums.residual.locally_owned_size())
            sums.residual.local_element(node) = 0.;

    const MPI_Comm communicator = space.communicator();
    FlowTotals     totals;
    totals.solid_volume = Utilities::MPI::sum(sums.solid, communicator);
    for (unsigned int d = 0; d < 2; ++d)
      totals.momentum[d] = solver.properties.density * Utilities::MPI::sum(sums.volume_flux[d], communicator);
    const double flux    = std::sqrt(Utilities::MPI::sum(sums.flux_square, communicator));
    totals.mass_residual = flux > 0. ? sums.residual.l2_norm() / flux : 0.;
    return totals;
  }
} // namespace alluvium::coupling
