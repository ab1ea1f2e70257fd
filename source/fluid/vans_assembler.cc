#include <alluvium/fluid/cell_mesh_terms.h>
#include <alluvium/fluid/cell_piece_terms.h>
#include <alluvium/fluid/face_state.h>
#include <alluvium/fluid/open_boundary_flow.h>
#include <alluvium/fluid/vans_assembler.h>

#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/block_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <int dim, int n>
    void fill_matrix(const CellState<dim, n> &state, LocalMatrix<dim, n> &L)
    {
      for (auto &row : L)
        row.fill(0.);
      add_mesh(state, L);
      add_pieces(state, L);
    }

    /** Add @p local to the entries of a cell without constraints. */
    template <int dim, typename LocalVector>
    void add_to(BlockVector &vector, const CellData<dim> &cell, const LocalVector &local)
    {
      for (unsigned int v = 0; v < local.size() / (dim + 1); ++v)
        {
          for (unsigned int d = 0; d < dim; ++d)
            vector.block(0).local_element(cell.velocity[v][d]) += local[v * (dim + 1) + d];
          vector.block(1).local_element(cell.pressure[v]) += local[v * (dim + 1) + dim];
        }
    }

    /** Call @p action with the cell state for the mesh's kind of cell. */
    template <int dim, typename Action>
    void with_cell_state(const FluidSpace<dim> &space, const VansProblem<dim> &problem, const Action &action)
    {
      if (space.n_nodes_per_cell() == dim + 1)
        action(CellState<dim, dim + 1>(space, problem));
      else
        action(CellState<dim, (1 << dim)>(space, problem));
    }
  } // namespace


  template <int dim>
  VansAssembler<dim>::VansAssembler(const FluidSpace<dim> &space)
    : space(&space)
  {}


  template <int dim>
  void VansAssembler<dim>::reinit()
  {
    system_matrix.clear();
    BlockDynamicSparsityPattern pattern(space->relevant());
    DoFTools::make_sparsity_pattern(space->dof_handler(),
                                    pattern,
                                    space->constraints(),
                                    false,
                                    Utilities::MPI::this_mpi_process(space->communicator()));
    SparsityTools::distribute_sparsity_pattern(
      pattern, space->dof_handler().locally_owned_dofs(), space->communicator(), space->relevant_dofs());
    system_matrix.reinit(space->owned(), pattern, space->communicator());
    system_matrix.compress(VectorOperation::insert);
    scatter.reinit(*space, system_matrix);
  }


  template <int dim>
  void VansAssembler<dim>::assemble(const VansProblem<dim> &problem,
                                    const BlockVector      &iterate,
                                    BlockVector            &residual,
                                    BlockVector            &known)
  {
    Assert(system_matrix.m() == space->dof_handler().n_dofs(), ExcMessage("reinit() comes after that of the space."));
    Assert(iterate.has_ghost_elements() && problem.old->has_ghost_elements(),
           ExcMessage("The fields' ghosts must be up to date."));
    Assert(!residual.has_ghost_elements() && !known.has_ghost_elements(),
           ExcMessage("Sums are not written to ghosts."));
    system_matrix = 0.;
    residual      = 0.;
    known         = 0.;
    scatter.find_values(system_matrix);
    with_cell_state<dim>(*space, problem, [&](auto state) {
      using K                                = decltype(state);
      constexpr unsigned int               n = K::n_local;
      typename K::Matrix                   L;
      typename K::Values                   b;
      FullMatrix<double>                   local_matrix(n, n);
      dealii::Vector<double>               local_residual(n), local_known(n);
      std::vector<types::global_dof_index> local_dofs(n);
      const auto                          &constraints = space->constraints();
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          const CellData<dim> &cell = space->cells()[i];
          state.reinit(i);
          fill_matrix(state, L);
          b.fill(0.);
          add_mesh_right_hand_side(state, b);
          typename K::Values b_pieces{};
          known_pieces(state, b_pieces);
          const typename K::Values x = state.values(iterate);
          for (unsigned int r = 0; r < n; ++r)
            for (unsigned int c = 0; c < n; ++c)
              b[r] -= L[r][c] * x[c];
          if (scatter.serves(i))
            {
              scatter.add(i, L);
              add_to(residual, cell, b);
              if (state.has_pieces())
                add_to(known, cell, b_pieces);
              continue;
            }
          for (unsigned int r = 0; r < n; ++r)
            {
              for (unsigned int c = 0; c < n; ++c)
                local_matrix(r, c) = L[r][c];
              local_residual(r) = b[r];
              local_known(r)    = b_pieces[r];
              local_dofs[r]     = cell.dofs[r];
            }
          constraints.distribute_local_to_global(local_matrix, local_dofs, system_matrix);
          constraints.distribute_local_to_global(local_residual, local_dofs, residual);
          if (state.has_pieces())
            constraints.distribute_local_to_global(local_known, local_dofs, known);
        }
      auto backflow = backflow_shares(*space, problem);
      for (const auto &face : space->boundary().faces())
        {
          const CellData<dim> &cell = space->cells()[face.cell];
          state.reinit(face.cell);
          const FaceTerms<dim>     terms = face_terms(state, face, backflow[face.boundary]);
          const typename K::Values x     = state.values(iterate);
          for (unsigned int r = 0; r < n; ++r)
            {
              local_residual(r) = terms.known[r];
              local_dofs[r]     = cell.dofs[r];
              for (unsigned int c = 0; c < n; ++c)
                {
                  local_matrix(r, c) = terms.matrix[r][c];
                  local_residual(r) -= terms.matrix[r][c] * x[c];
                }
            }
          constraints.distribute_local_to_global(local_matrix, local_dofs, system_matrix);
          constraints.distribute_local_to_global(local_residual, local_dofs, residual);
        }
      // the boundary term of the continuity equation where the velocity is given
      for (std::size_t i = 0; problem.given_fluxes && i < space->boundary().inflow_faces().size(); ++i)
        {
          const InflowFace<dim> &face = space->boundary().inflow_faces()[i];
          if (!face.owned)
            continue;
          const CellData<dim> &cell = space->cells()[face.cell];
          local_residual            = 0.;
          for (unsigned int e = 0; e < 2; ++e)
            local_residual(face.vertex[e] * (dim + 1) + dim) -= (*problem.given_fluxes)[i][e];
          for (unsigned int r = 0; r < n; ++r)
            local_dofs[r] = cell.dofs[r];
          constraints.distribute_local_to_global(local_residual, local_dofs, residual);
        }
    });
    system_matrix.compress(VectorOperation::add);
    residual.compress(VectorOperation::add);
    known.compress(VectorOperation::add);
    residual += known;
  }


  template <int dim>
  void VansAssembler<dim>::known_interphase(const VansProblem<dim> &problem, BlockVector &known) const
  {
    known = 0.;
    with_cell_state<dim>(*space, problem, [&](auto state) {
      using K                                = decltype(state);
      constexpr unsigned int               n = K::n_local;
      typename K::Values                   b;
      dealii::Vector<double>               local(n);
      std::vector<types::global_dof_index> local_dofs(n);
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          if (problem.solid->begin[i] == problem.solid->begin[i + 1])
            continue;
          state.reinit(i);
          b.fill(0.);
          known_pieces(state, b);
          for (unsigned int r = 0; r < n; ++r)
            {
              local(r)      = b[r];
              local_dofs[r] = space->cells()[i].dofs[r];
            }
          space->constraints().distribute_local_to_global(local, local_dofs, known);
        }
    });
    known.compress(VectorOperation::add);
  }


  template <int dim>
  double VansAssembler<dim>::flux(const VansProblem<dim>  &problem,
                                  const BlockVector       &solution,
                                  const types::boundary_id id) const
  {
    const auto passes_by_terms = [&](const types::boundary_id boundary) {
      return problem.boundary_conditions && problem.boundary_conditions->all().at(boundary).kind->has_mass_terms();
    };
    const auto &weights = space->boundary().weights_at(id);
    const auto  own     = passes_by_terms(id);
    double      sum     = 0.;
    with_cell_state<dim>(*space, problem, [&](auto state) {
      using K                  = decltype(state);
      constexpr unsigned int n = K::n_local;
      typename K::Matrix     L;
      typename K::Values     b;
      // what passes by terms is what the continuity equation gets of them, here or close by
      for (const auto &face : space->boundary().faces())
        {
          if (!passes_by_terms(face.boundary))
            continue;
          const auto w = std::lower_bound(
            weights.begin(), weights.end(), face.cell, [](const auto &w, const unsigned int c) { return w.cell < c; });
          if (own ? face.boundary != id : w == weights.end() || w->cell != face.cell)
            continue;
          state.reinit(face.cell);
          const FaceTerms<dim>     terms = face_terms(state, face, 0.);
          const typename K::Values x     = state.values(solution);
          for (unsigned int v = 0; v < n / (dim + 1); ++v)
            {
              const unsigned int row = FaceTerms<dim>::row(v, dim);
              double             out = -terms.known[row];
              for (unsigned int c = 0; c < n; ++c)
                out += terms.matrix[row][c] * x[c];
              sum += own ? out : -w->weight[v] * out;
            }
        }
      if (own)
        return;
      for (const auto &[i, weight] : weights)
        {
          state.reinit(i);
          fill_matrix(state, L);
          b.fill(0.);
          add_mesh_right_hand_side(state, b);
          known_pieces(state, b);
          const typename K::Values x = state.values(solution);
          for (unsigned int v = 0; v < n / (dim + 1); ++v)
            {
              const unsigned int row = v * (dim + 1) + dim;
              double             r   = b[row];
              for (unsigned int c = 0; c < n; ++c)
                r -= L[row][c] * x[c];
              sum += weight[v] * r;
            }
        }
    });
    // what comes in where the velocity is given close by
    for (std::size_t i = 0; !own && problem.given_fluxes && i < space->boundary().inflow_faces().size(); ++i)
      {
        const InflowFace<dim> &face = space->boundary().inflow_faces()[i];
        const auto             w    = std::lower_bound(
          weights.begin(), weights.end(), face.cell, [](const auto &w, const unsigned int c) { return w.cell < c; });
        if (face.owned && w != weights.end() && w->cell == face.cell)
          for (unsigned int e = 0; e < 2; ++e)
            sum -= w->weight[face.vertex[e]] * (*problem.given_fluxes)[i][e];
      }
    return Utilities::MPI::sum(sum, space->communicator());
  }


  namespace
  {
    /** Call @p action(point, force) with what the pieces put into the momentum equations of each cell's nodes. */
    template <int dim, typename Action>
    void for_each_interphase_force(const FluidSpace<dim>  &space,
                                   const VansProblem<dim> &problem,
                                   const BlockVector      &solution,
                                   const Action           &action)
    {
      with_cell_state<dim>(space, problem, [&](auto state) {
        using K                  = decltype(state);
        constexpr unsigned int n = K::n_local;
        typename K::Matrix     L;
        typename K::Values     r;
        for (unsigned int i = 0; i < space.cells().size(); ++i)
          {
            const CellData<dim> &cell = space.cells()[i];
            state.reinit(i);
            for (auto &row : L)
              row.fill(0.);
            r.fill(0.);
            add_pieces(state, L);
            known_pieces(state, r);
            const typename K::Values x = state.values(solution);
            for (unsigned int v = 0; v < n / (dim + 1); ++v)
              {
                std::array<double, dim> force;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    const unsigned int row = v * (dim + 1) + d;
                    force[d]               = r[row];
                    for (unsigned int c = 0; c < n; ++c)
                      force[d] -= L[row][c] * x[c];
                  }
                action(cell.vertex[v], force);
              }
          }
      });
    }
  } // namespace


  template <int dim>
  std::array<double, dim> VansAssembler<dim>::interphase_force(const VansProblem<dim> &problem,
                                                               const BlockVector      &solution) const
  {
    std::array<double, dim> sum{};
    for_each_interphase_force(*space, problem, solution, [&](const Point<dim> &, const std::array<double, dim> &force) {
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += force[d];
    });
    for (double &s : sum)
      s = Utilities::MPI::sum(s, space->communicator());
    return sum;
  }


  template <int dim>
  double VansAssembler<dim>::interphase_torque(const VansProblem<dim> &problem, const BlockVector &solution) const
  {
    double sum = 0.;
    for_each_interphase_force(
      *space, problem, solution, [&](const Point<dim> &x, const std::array<double, dim> &force) {
        sum += x[0] * force[1] - x[1] * force[0];
      });
    return Utilities::MPI::sum(sum, space->communicator());
  }


  template <int dim>
  std::array<double, 2> VansAssembler<dim>::term_norms(const VansProblem<dim> &problem,
                                                       const BlockVector      &iterate) const
  {
    double momentum = 0., continuity = 0.;
    with_cell_state<dim>(*space, problem, [&](auto state) {
      for (unsigned int i = 0; i < space->cells().size(); ++i)
        {
          state.reinit_void_fraction(i);
          term_squares(state, iterate, momentum, continuity);
        }
    });
    const MPI_Comm comm = space->communicator();
    return {{std::sqrt(Utilities::MPI::sum(momentum, comm)), std::sqrt(Utilities::MPI::sum(continuity, comm))}};
  }


  template class VansAssembler<2>;
} // namespace alluvium::fluid
