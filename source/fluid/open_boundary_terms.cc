#include <alluvium/fluid/cell_mesh_terms.h>
#include <alluvium/fluid/open_boundary_terms.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <optional>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /**
     * The mean over the cell of what streamline upwinding weights, du/dt + grad p less body forces, as rows of a matrix
     * and known terms: upwind weights sum to zero, so that it is the sum of the cell's rows, less advection.
     */
    template <int dim, int n>
    struct MeanResidual
    {
      std::array<LocalVector<dim, n>, dim> row{};
      std::array<double, dim>              known{};

      explicit MeanResidual(const CellState<dim, n> &state)
      {
        LocalMatrix<dim, n> L{};
        LocalVector<dim, n> b{};
        add_mesh(state, L);
        add_mesh_right_hand_side(state, b);
        const double measure = state.cell->measure;
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int c = 0; c < dim; ++c)
            {
              for (unsigned int j = 0; j < L.size(); ++j)
                row[c][j] += L[i * (dim + 1) + c][j] / measure;
              known[c] += b[i * (dim + 1) + c] / measure;
            }
        for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
          {
            const auto  &phi        = state.space.shape_values()[q];
            const auto   streamline = state.advect(state.cell->grad[q], phi);
            const double inertia    = state.cell->jxw[q] * state.value(state.eps, phi) * state.problem.fluid.density;
            for (unsigned int j = 0; j < n; ++j)
              for (unsigned int c = 0; c < dim; ++c)
                row[c][j * (dim + 1) + c] -= inertia * streamline[j] / measure;
          }
      }
    };

    /** u^n.n where the shape functions are @p phi; zero without convection. */
    template <int dim, int n>
    double normal_velocity(const CellState<dim, n>                  &state,
                           const std::array<double, max_nodes<dim>> &phi,
                           const Tensor<1, dim>                     &normal)
    {
      double u = 0.;
      if (state.problem.discretisation.convection)
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            u += phi[v] * state.u_old[v][d] * normal[d];
      return u;
    }

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
      for (const auto &face : space.boundary().open_faces())
        {
          const CellData<dim> &cell = space.cells()[face.cell];
          const auto           i    = std::lower_bound(ids.begin(), ids.end(), face.boundary) - ids.begin();
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


  template <int dim, int n>
  void add_open_face(const CellState<dim, n> &state,
                     const OpenFace<dim>     &face,
                     const double             backflow,
                     LocalMatrix<dim, n>     &L,
                     LocalVector<dim, n>     &b)
  {
    const OpenBoundaryTerms            &terms     = state.problem.discretisation.open_boundary;
    const double                        rho       = state.problem.fluid.density;
    const double                        viscosity = terms.traction ? state.problem.stress_viscosity() : 0.;
    std::optional<MeanResidual<dim, n>> upwinded;
    // upwinding knows no viscous term: only where viscosity can balance the rest, and momentum stays that of the pieces
    if (terms.upwinding && state.problem.discretisation.convection && !state.has_pieces())
      upwinded.emplace(state);
    for (unsigned int q = 0; q < face.phi.size(); ++q)
      {
        const auto           &phi    = face.phi[q];
        const auto           &grad   = face.grad[q];
        const Tensor<1, dim> &normal = face.normal[q];
        const double          eps = state.value(state.eps, phi), out = normal_velocity(state, phi, normal);
        const double          entering   = face.jxw[q] * eps * rho * std::max(0., -out);
        const double          advection  = terms.advection ? entering * face.depth : 0.;
        const double          tangential = terms.tangential ? entering : 0.;
        const double          loss       = terms.backflow ? entering * 0.5 * backflow : 0.;
        const double          transposed = face.jxw[q] * eps * viscosity;
        // where kinetic energy is lost, the loss is in the pressure gradient
        const double upwind = upwinded ? face.jxw[q] * state.supg * (out > 0. ? out : (1. - backflow) * out) : 0.;
        std::array<double, n> along; // d/dn of each shape function
        for (unsigned int j = 0; j < n; ++j)
          {
            along[j] = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              along[j] += grad[j][d] * normal[d];
          }
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int c = 0; c < dim; ++c)
            {
              auto &row = L[i * (dim + 1) + c];
              for (unsigned int j = 0; j < n; ++j)
                {
                  row[j * (dim + 1) + c] += phi[i] * ((loss + tangential) * phi[j] + advection * along[j]);
                  for (unsigned int d = 0; d < dim; ++d)
                    row[j * (dim + 1) + d] -=
                      phi[i] * normal[d] * (tangential * phi[j] * normal[c] + transposed * grad[j][c]);
                }
              if (!upwinded)
                continue;
              for (unsigned int j = 0; j < row.size(); ++j)
                row[j] -= upwind * phi[i] * upwinded->row[c][j];
              b[i * (dim + 1) + c] -= upwind * phi[i] * upwinded->known[c];
            }
      }
  }


  template std::map<types::boundary_id, double> backflow_shares(const FluidSpace<2> &, const VansProblem<2> &);
  template std::map<types::boundary_id, double>
  dynamic_pressures(const FluidSpace<2> &, const double, const BlockVector &);
  template void
  add_open_face(const CellState<2, 3> &, const OpenFace<2> &, double, LocalMatrix<2, 3> &, LocalVector<2, 3> &);
  template void
  add_open_face(const CellState<2, 4> &, const OpenFace<2> &, double, LocalMatrix<2, 4> &, LocalVector<2, 4> &);
} // namespace alluvium::fluid
