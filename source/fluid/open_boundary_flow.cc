#include <alluvium/fluid/open_boundary_flow.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** What enters through a boundary. */
    struct Inflow
    {
      double gross = 0., net = 0., square = 0.; // [m^2/s], [m^2/s], integral of the cube [m^4/s^3]

      double backflow_share() const { return gross > 0. ? 1. - std::clamp(net / gross, 0., 1.) : 0.; }
      double mean_square() const { return gross > 0. ? square / gross : 0.; }
    };

    template <int dim>
    std::map<types::boundary_id, Inflow> inflows(const FluidSpace<dim> &space, const BlockVector &field)
    {
      const std::vector<types::boundary_id> &ids = space.boundary().open_boundaries();
      std::vector<double>                    sums(3 * ids.size(), 0.);
      for (const auto &face : space.boundary().faces())
        {
          const CellData<dim> &cell = space.cells()[face.cell];
          const std::size_t    i    = std::lower_bound(ids.begin(), ids.end(), face.boundary) - ids.begin();
          if (i == ids.size() || ids[i] != face.boundary)
            continue;
          for (unsigned int q = 0; q < face.phi.size(); ++q)
            {
              double out = 0.;
              for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  out += face.phi[q][v] * field.block(0).local_element(cell.velocity[v][d]) * face.normal[q][d];
              const double in = std::max(0., -out);
              sums[3 * i] += face.jxw[q] * in;
              sums[3 * i + 1] -= face.jxw[q] * out;
              sums[3 * i + 2] += face.jxw[q] * in * in * in;
            }
        }
      if (!ids.empty())
        Utilities::MPI::sum(sums, space.communicator(), sums);
      std::map<types::boundary_id, Inflow> result;
      for (std::size_t i = 0; i < ids.size(); ++i)
        result[ids[i]] = {sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]};
      return result;
    }
  } // namespace


  template <int dim>
  std::map<types::boundary_id, double> backflow_shares(const FluidSpace<dim> &space, const VansProblem<dim> &problem)
  {
    std::map<types::boundary_id, double> shares;
    if (!problem.discretisation.convection)
      {
        for (const auto id : space.boundary().open_boundaries())
          shares[id] = 0.;
        return shares;
      }
    for (const auto &[id, inflow] : inflows(space, *problem.old))
      shares[id] = inflow.backflow_share();
    return shares;
  }


  template <int dim>
  std::map<types::boundary_id, double>
  dynamic_pressures(const FluidSpace<dim> &space, const double density, const BlockVector &field)
  {
    std::map<types::boundary_id, double> pressures;
    for (const auto &[id, inflow] : inflows(space, field))
      pressures[id] = (1. - inflow.backflow_share()) * 0.5 * density * inflow.mean_square();
    return pressures;
  }


  template std::map<types::boundary_id, double> backflow_shares(const FluidSpace<2> &, const VansProblem<2> &);
  template std::map<types::boundary_id, double>
  dynamic_pressures(const FluidSpace<2> &, const double, const BlockVector &);
} // namespace alluvium::fluid
