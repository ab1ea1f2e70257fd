#include <alluvium/fluid/flow_terms.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/affine_constraints.h>

#include <array>
#include <cmath>
#include <vector>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_terms = 4;

    /** The terms at a point, tested with the shape function of value @p phi and gradient @p grad. */
    template <int dim>
    struct PointTerms
    {
      double         mass, viscous; // eps rho, eps eta
      double         eps;
      Tensor<1, dim> u, rate, grad_p;
      Tensor<2, dim> grad_u; // [component][direction]

      std::array<double, n_terms>
      tested(const double phi, const std::array<double, dim> &grad, const unsigned int c) const
      {
        double convection = 0., viscosity = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            convection += u[d] * grad_u[c][d];
            viscosity += grad[d] * (grad_u[c][d] + grad_u[d][c]);
          }
        return {{mass * rate[c] * phi, mass * convection * phi, viscous * viscosity, eps * grad_p[c] * phi}};
      }
    };

    template <int dim>
    PointTerms<dim> terms_at(const FluidSpace<dim>  &space,
                             const VansProblem<dim> &problem,
                             const CellData<dim>    &cell,
                             const unsigned int      q,
                             const BlockVector      &solution,
                             const BlockVector      &before)
    {
      PointTerms<dim> at{};
      const auto     &phi = space.shape_values()[q];
      for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
        {
          at.eps += phi[v] * problem.void_fraction->local_element(cell.node[v]);
          const double p = solution.block(1).local_element(cell.pressure[v]);
          for (unsigned int c = 0; c < dim; ++c)
            {
              const double u = solution.block(0).local_element(cell.velocity[v][c]);
              at.u[c] += phi[v] * u;
              at.rate[c] += phi[v] * (u - before.block(0).local_element(cell.velocity[v][c])) / problem.dt;
              at.grad_p[c] += cell.grad[q][v][c] * p;
              for (unsigned int d = 0; d < dim; ++d)
                at.grad_u[c][d] += cell.grad[q][v][d] * u;
            }
        }
      at.mass    = at.eps * problem.fluid.density;
      at.viscous = at.eps * problem.fluid.viscosity;
      return at;
    }
  } // namespace


  template <int dim>
  FlowTerms flow_terms(const FluidSpace<dim>  &space,
                       const VansProblem<dim> &problem,
                       const BlockVector      &solution,
                       const BlockVector      &before,
                       const BlockVector      &volumes)
  {
    const unsigned int                   n_nodes = space.n_nodes_per_cell(), n = n_nodes * (dim + 1);
    std::array<BlockVector, n_terms>     of_nodes;
    std::vector<types::global_dof_index> dofs(n);
    dealii::Vector<double>               local(n);
    for (BlockVector &field : of_nodes)
      space.reinit_field(field);
    for (const CellData<dim> &cell : space.cells())
      {
        std::array<std::vector<double>, n_terms> sums;
        for (auto &sum : sums)
          sum.assign(n, 0.);
        for (unsigned int q = 0; q < space.n_q_points(); ++q)
          {
            const PointTerms<dim> at = terms_at(space, problem, cell, q, solution, before);
            for (unsigned int v = 0; v < n_nodes; ++v)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const auto tested = at.tested(space.shape_values()[q][v], cell.grad[q][v], c);
                  for (unsigned int t = 0; t < n_terms; ++t)
                    sums[t][v * (dim + 1) + c] += cell.jxw[q] * tested[t];
                }
          }
        for (unsigned int r = 0; r < n; ++r)
          dofs[r] = cell.dofs[r];
        for (unsigned int t = 0; t < n_terms; ++t)
          {
            std::copy(sums[t].begin(), sums[t].end(), local.begin());
            space.constraints().distribute_local_to_global(local, dofs, of_nodes[t]);
          }
      }
    std::array<double, n_terms> squares{};
    for (unsigned int t = 0; t < n_terms; ++t)
      {
        of_nodes[t].compress(VectorOperation::add);
        const auto &force = of_nodes[t].block(0);
        for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
          if (const double volume = volumes.block(0).local_element(i); volume > 0.)
            squares[t] += force.local_element(i) * force.local_element(i) / volume;
      }
    Utilities::MPI::sum(ArrayView<const double>(squares.data(), n_terms),
                        space.communicator(),
                        ArrayView<double>(squares.data(), n_terms));
    return {std::sqrt(squares[0]), std::sqrt(squares[1]), std::sqrt(squares[2]), std::sqrt(squares[3])};
  }


  template FlowTerms flow_terms(
    const FluidSpace<2> &, const VansProblem<2> &, const BlockVector &, const BlockVector &, const BlockVector &);
} // namespace alluvium::fluid
