#include <alluvium/fluid/cell_mesh_terms.h>
#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/cell_piece_terms.h>
#include <alluvium/fluid/energy_balance.h>
#include <alluvium/fluid/face_state.h>
#include <alluvium/fluid/open_boundary_flow.h>
#include <alluvium/fluid/piece_gradients.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <int dim, int n, typename Matrix, typename Vector>
    double product(const LocalVector<dim, n> &x, const Matrix &L, const Vector &b)
    {
      double sum = 0.;
      for (unsigned int r = 0; r < x.size(); ++r)
        {
          double residual = -b[r];
          for (unsigned int c = 0; c < x.size(); ++c)
            residual += L[r][c] * x[c];
          sum += x[r] * residual;
        }
      return sum;
    }

    /** Fields and gradients where the shape functions are phi. */
    template <int dim>
    struct Values
    {
      Tensor<1, dim> u, old, grad_p;
      Tensor<2, dim> grad_u; // [component][direction]

      template <int n>
      Values(const CellState<dim, n>       &state,
             const LocalVector<dim, n>     &x,
             const double                  *phi,
             const std::array<double, dim> *grad)
      {
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            {
              u[d] += phi[v] * x[v * (dim + 1) + d];
              old[d] += phi[v] * state.u_start[v][d];
              grad_p[d] += grad[v][d] * x[v * (dim + 1) + dim];
              for (unsigned int c = 0; c < dim; ++c)
                grad_u[c][d] += grad[v][d] * x[v * (dim + 1) + c];
            }
      }
    };

    /** The Galerkin terms of a cell; what the weak form has besides is the stabilisation. */
    template <int dim, int n>
    void add_cell(const CellState<dim, n> &state, const LocalVector<dim, n> &x, EnergyBalance &sum)
    {
      const VansProblem<dim> &problem = state.problem;
      const double            rho = problem.fluid.density, eta = problem.fluid.viscosity;
      double                  galerkin = 0.; // that is neither time nor convection
      for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
        {
          const auto       &phi = state.space.shape_values()[q];
          const Values<dim> at(state, x, phi.data(), state.cell->grad[q].data());
          const double      jxw = state.cell->jxw[q], eps = state.value(state.eps, phi), mass = jxw * eps * rho;
          const double      kinetic = 0.5 * mass * at.u.norm_square(), before = 0.5 * mass * at.old.norm_square();
          sum.kinetic_energy += kinetic;
          sum.kinetic_before += before;
          const double time = 0.5 * mass * (at.u - at.old).norm_square() / problem.dt;
          sum.time += time;
          const double viscous = jxw * eps * eta * scalar_product(at.grad_u + transpose(at.grad_u), at.grad_u);
          sum.viscous += viscous;
          galerkin += (kinetic - before) / problem.dt + time + viscous;
          galerkin += jxw * (1. - eps) * (at.grad_p * at.u);
          const auto streamline = state.advect(state.cell->grad[q], phi);
          for (unsigned int v = 0; v < n; ++v)
            for (unsigned int d = 0; d < dim; ++d)
              galerkin += mass * streamline[v] * x[v * (dim + 1) + d] * at.u[d];
          double drive = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            drive += jxw * eps * problem.drive[d] * at.u[d];
          sum.body += drive;
          galerkin -= drive;
          if (problem.body_force || problem.mass_source)
            {
              Point<dim> place;
              for (unsigned int v = 0; v < n; ++v)
                place += phi[v] * state.cell->vertex[v];
              double power = 0.;
              if (problem.body_force)
                for (unsigned int d = 0; d < dim; ++d)
                  power += jxw * problem.body_force->value(place, d) * at.u[d];
              if (problem.mass_source)
                {
                  double p = 0.;
                  for (unsigned int v = 0; v < n; ++v)
                    p += phi[v] * x[v * (dim + 1) + dim];
                  power += jxw * problem.mass_source->value(place) * p;
                }
              sum.body += power;
              galerkin -= power;
            }
        }
      for (unsigned int k = state.begin; k < state.end; ++k)
        {
          const PieceShape<dim>    &s    = problem.solid->shape[k];
          const PieceExchange<dim> &ex   = problem.solid->exchange[k];
          const auto                grad = piece_gradients<n>(*state.cell, s.phi);
          const Values<dim>         at(state, x, s.phi.data(), grad.data());
          const Vector             *reference = problem.reference[ex.reference];
          for (unsigned int d = 0; d < dim; ++d)
            {
              double lagged = 0.;
              if (reference)
                for (unsigned int v = 0; v < n; ++v)
                  lagged += s.phi[v] * reference->local_element(state.cell->velocity[v][d]);
              const double solid =
                ex.a[d] + ex.gamma * ex.compliance * (at.u[d] - lagged) - ex.compliance * at.grad_p[d];
              const double force  = ex.gamma * (at.u[d] - solid) + ex.e[d]; // without the pressure's
              const double grains = s.area * (force - at.grad_p[d]) * solid, drag = s.area * force * (at.u[d] - solid);
              sum.to_grains += grains;
              sum.drag += drag;
              // the pressure's part of what the solid receives is in the continuity equation, not in the slip
              galerkin += grains + drag - s.area * at.grad_p[d] * at.u[d];
            }
        }
      LocalMatrix<dim, n> L{};
      LocalVector<dim, n> b{};
      add_mesh(state, L);
      add_pieces(state, L);
      add_mesh_right_hand_side(state, b);
      known_pieces(state, b);
      const double all = product<dim, n>(x, L, b);
      sum.boundaries += all;
      sum.stabilisation += all - galerkin;
    }

    template <int dim, int n>
    void add_face(const CellState<dim, n>   &state,
                  const BoundaryFace<dim>   &face,
                  const double               backflow,
                  const LocalVector<dim, n> &x,
                  EnergyBalance             &sum)
    {
      const auto   terms = face_terms(state, face, backflow);
      const double taken = product<dim, n>(x, terms.matrix, terms.known);
      sum.open += taken;
      sum.boundaries += taken;
    }

    /** Kinetic energy that goes out through the face from node @p a to @p b [W/m], a straight one. */
    template <int dim, int n>
    double carried_out(const CellState<dim, n>   &state,
                       const LocalVector<dim, n> &x,
                       const unsigned int         a,
                       const unsigned int         b)
    {
      const Point<dim> &from = state.cell->vertex[a], &to = state.cell->vertex[b];
      Tensor<1, dim>    normal, inwards; // outwards, as long as the face
      normal[0] = to[1] - from[1];
      normal[1] = from[0] - to[0];
      for (unsigned int v = 0; v < n; ++v)
        inwards += state.cell->vertex[v] - from;
      if (normal * inwards > 0.)
        normal *= -1.;
      static const QGauss<1> quadrature(3); // a product of four linear functions
      double                 sum = 0.;
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        {
          std::array<double, n> phi{};
          phi[b] = quadrature.point(q)[0];
          phi[a] = 1. - phi[b];
          Tensor<1, dim> u, old;
          for (const unsigned int v : {a, b})
            for (unsigned int d = 0; d < dim; ++d)
              {
                u[d] += phi[v] * x[v * (dim + 1) + d];
                old[d] += phi[v] * state.u_old[v][d];
              }
          sum += quadrature.weight(q) * 0.5 * state.problem.fluid.density * state.value(state.eps, phi) *
                 (old * normal) * u.norm_square();
        }
      return sum;
    }

    /**
     * Kinetic energy that goes out through the whole boundary [W/m]: also through walls beside an opening, as the
     * velocity of its last node falls to zero along the face that ends there.
     */
    template <int dim, int n>
    double carried_out(CellState<dim, n> &state, const BlockVector &solution)
    {
      const FluidSpace<dim> &space = state.space;
      double                 sum   = 0.;
      unsigned int           index = 0;
      for (const auto &cell : ordered_cells(space.dof_handler()))
        {
          if (!cell->is_locally_owned())
            continue;
          const unsigned int i = index++;
          if (!cell->at_boundary())
            continue;
          state.reinit(i);
          const auto x = state.values(solution);
          for (const unsigned int f : cell->face_indices())
            {
              const auto face = cell->face(f);
              if (!face->at_boundary() || space.periodic_box().length[face->boundary_id() / 2 % dim] > 0.)
                continue;
              std::array<unsigned int, 2> ends{};
              for (unsigned int e = 0; e < 2; ++e)
                for (unsigned int v = 0; v < n; ++v)
                  if (cell->vertex_index(v) == face->vertex_index(e))
                    ends[e] = v;
              sum += carried_out<dim, n>(state, x, ends[0], ends[1]);
            }
        }
      return sum;
    }

    template <int dim, int n>
    void add_all(const FluidSpace<dim>  &space,
                 const VansProblem<dim> &problem,
                 const BlockVector      &solution,
                 EnergyBalance          &sum)
    {
      CellState<dim, n> state(space, problem);
      for (unsigned int i = 0; i < space.cells().size(); ++i)
        {
          state.reinit(i);
          add_cell(state, state.values(solution), sum);
        }
      auto backflow = backflow_shares(space, problem);
      for (const auto &face : space.boundary().faces())
        {
          state.reinit(face.cell);
          add_face(state, face, backflow[face.boundary], state.values(solution), sum);
        }
      if (problem.discretisation.convection)
        sum.boundaries -= carried_out(state, solution);
    }
  } // namespace


  double EnergyBalance::largest() const
  {
    double result = 0.;
    for (const double power : {boundaries, body, to_grains, drag, viscous, stabilisation, time, open})
      result = std::max(result, std::abs(power));
    return result;
  }


  template <int dim>
  EnergyBalance
  energy_balance(const FluidSpace<dim> &space, const VansProblem<dim> &problem, const BlockVector &solution)
  {
    EnergyBalance sum;
    if (space.n_nodes_per_cell() == dim + 1)
      add_all<dim, dim + 1>(space, problem, solution, sum);
    else
      add_all<dim, (1 << dim)>(space, problem, solution, sum);
    for (double *x : {&sum.kinetic_energy,
                      &sum.kinetic_before,
                      &sum.boundaries,
                      &sum.body,
                      &sum.to_grains,
                      &sum.drag,
                      &sum.viscous,
                      &sum.stabilisation,
                      &sum.time,
                      &sum.open})
      *x = Utilities::MPI::sum(*x, space.communicator());
    return sum;
  }


  template EnergyBalance energy_balance(const FluidSpace<2> &, const VansProblem<2> &, const BlockVector &);
} // namespace alluvium::fluid
