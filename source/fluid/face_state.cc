#include <alluvium/fluid/cell_mesh_terms.h>
#include <alluvium/fluid/face_state.h>

#include <deal.II/base/exceptions.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <int dim, int n>
    MeanResidual<dim> mean_residual_of(const CellState<dim, n> &state)
    {
      MeanResidual<dim>   result;
      LocalMatrix<dim, n> L{};
      LocalVector<dim, n> b{};
      add_mesh(state, L);
      add_mesh_right_hand_side(state, b);
      const double measure = state.cell->measure;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int c = 0; c < dim; ++c)
          {
            for (unsigned int j = 0; j < L.size(); ++j)
              result.row[c][j] += L[i * (dim + 1) + c][j] / measure;
            result.known[c] += b[i * (dim + 1) + c] / measure;
          }
      for (unsigned int q = 0; q < state.space.n_q_points(); ++q)
        {
          const auto  &phi        = state.space.shape_values()[q];
          const auto   streamline = state.advect(state.cell->grad[q], phi);
          const double inertia    = state.cell->jxw[q] * state.value(state.eps, phi) * state.problem.fluid.density;
          for (unsigned int j = 0; j < n; ++j)
            for (unsigned int c = 0; c < dim; ++c)
              result.row[c][j * (dim + 1) + c] -= inertia * streamline[j] / measure;
        }
      return result;
    }
  } // namespace


  template <int dim>
  template <int n>
  FaceState<dim>::FaceState(const CellState<dim, n> &cell, const BoundaryFace<dim> &face, const double backflow)
    : face(face)
    , problem(cell.problem)
    , backflow(backflow)
    , supg(cell.supg)
    , has_pieces(cell.has_pieces())
    , condition(&cell.problem.boundary_conditions->all().at(face.boundary))
    , nodes(n)
    , eps()
    , u_old()
    , find_mean_residual([&cell] { return mean_residual_of(cell); })
  {
    for (unsigned int v = 0; v < n; ++v)
      {
        eps[v]   = cell.eps[v];
        u_old[v] = cell.u_old[v];
      }
  }


  template <int dim>
  double FaceState<dim>::void_fraction(const unsigned int q) const
  {
    double sum = 0.;
    for (unsigned int v = 0; v < nodes; ++v)
      sum += eps[v] * face.phi[q][v];
    return sum;
  }


  template <int dim>
  double FaceState<dim>::old_normal_velocity(const unsigned int q) const
  {
    double u = 0.;
    for (unsigned int v = 0; v < nodes; ++v)
      for (unsigned int d = 0; d < dim; ++d)
        u += face.phi[q][v] * u_old[v][d] * face.normal[q][d];
    return u;
  }


  template <int dim>
  double FaceState<dim>::pressure_left_out(const unsigned int q) const
  {
    return problem.background_gradient * face.point[q] + problem.pressure_datum;
  }


  template <int dim, int n>
  FaceTerms<dim> face_terms(const CellState<dim, n> &state, const BoundaryFace<dim> &face, const double backflow)
  {
    AssertThrow(
      state.problem.boundary_conditions != nullptr,
      ExcMessage("A problem whose boundaries have terms needs its boundary conditions; begin_step() sets them."));
    FaceTerms<dim> result;
    const auto    &condition = state.problem.boundary_conditions->all().at(face.boundary);
    condition.kind->add_terms(FaceState<dim>(state, face, backflow), result);
    return result;
  }


  template class FaceState<2>;
  template FaceTerms<2> face_terms(const CellState<2, 3> &, const BoundaryFace<2> &, const double);
  template FaceTerms<2> face_terms(const CellState<2, 4> &, const BoundaryFace<2> &, const double);
} // namespace alluvium::fluid
