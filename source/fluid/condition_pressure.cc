#include <alluvium/fluid/boundary_scene.h>
#include <alluvium/fluid/face_state.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /**
     * A given pressure. Its terms are those of doc/theory/open-boundaries.md, in the rows of the momentum equation:
     * traction without the transposed gradient, no streamline upwinding across the face, and where flow enters no
     * advection from outside, no tangential velocity, and for backflow the loss of its kinetic energy.
     */
    class GivenPressure : public BoundaryKind<2>
    {
    public:
      Velocity     velocity() const override { return Velocity::free; }
      bool         gives_pressure() const override { return true; }
      unsigned int n_values() const override { return 1; }
      std::string  in_words() const override { return "pressure"; }
      bool         has_terms() const override { return true; }
      void         add_terms(const FaceState<2> &state, FaceTerms<2> &terms) const override;
      std::string  check(const BoundaryScene<2> &scene) const override;
    };


    void GivenPressure::add_terms(const FaceState<2> &state, FaceTerms<2> &result) const
    {
      constexpr unsigned int           dim        = 2;
      const BoundaryFace<dim>         &face       = state.face;
      const unsigned int               n          = state.n_nodes();
      const bool                       convection = state.problem.discretisation.convection;
      const OpenBoundaryTerms         &terms      = state.problem.discretisation.open_boundary;
      const double                     rho        = state.problem.fluid.density;
      const double                     viscosity  = terms.traction ? state.problem.fluid.viscosity : 0.;
      std::optional<MeanResidual<dim>> upwinded;
      // upwinding knows no viscous term: only where viscosity can balance the rest, and momentum stays that of the
      // pieces
      if (terms.upwinding && convection && !state.has_pieces)
        upwinded = state.mean_residual();
      for (unsigned int q = 0; q < state.n_q_points(); ++q)
        {
          const auto           &phi        = face.phi[q];
          const auto           &grad       = face.grad[q];
          const Tensor<1, dim> &normal     = face.normal[q];
          const double          eps        = state.void_fraction(q);
          const double          out        = convection ? state.old_normal_velocity(q) : 0.;
          const double          entering   = face.jxw[q] * eps * rho * std::max(0., -out);
          const double          advection  = terms.advection ? entering * face.depth : 0.;
          const double          tangential = terms.tangential ? entering : 0.;
          const double          loss       = terms.backflow ? entering * 0.5 * state.backflow : 0.;
          const double          transposed = face.jxw[q] * eps * viscosity;
          // where kinetic energy is lost, the loss is in the pressure gradient
          const double upwind =
            upwinded ? face.jxw[q] * state.supg * (out > 0. ? out : (1. - state.backflow) * out) : 0.;
          std::array<double, max_nodes<dim>> along; // d/dn of each shape function
          for (unsigned int j = 0; j < n; ++j)
            {
              along[j] = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                along[j] += grad[j][d] * normal[d];
            }
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int c = 0; c < dim; ++c)
              {
                auto &row = result.matrix[FaceTerms<dim>::row(i, c)];
                for (unsigned int j = 0; j < n; ++j)
                  {
                    row[FaceTerms<dim>::row(j, c)] += phi[i] * ((loss + tangential) * phi[j] + advection * along[j]);
                    for (unsigned int d = 0; d < dim; ++d)
                      row[FaceTerms<dim>::row(j, d)] -=
                        phi[i] * normal[d] * (tangential * phi[j] * normal[c] + transposed * grad[j][c]);
                  }
                if (!upwinded)
                  continue;
                for (unsigned int j = 0; j < n * (dim + 1); ++j)
                  row[j] -= upwind * phi[i] * upwinded->row[c][j];
                result.known[FaceTerms<dim>::row(i, c)] -= upwind * phi[i] * upwinded->known[c];
              }
        }
    }


    /** A pressure that is the same at all levels lets fluid fall along a boundary that is not level. */
    std::string GivenPressure::check(const BoundaryScene<2> &s) const
    {
      const double g = s.gravity.norm(), rho = s.fluid.density;
      const auto  &c = s.condition;
      if (c.add_hydrostatic || g == 0.)
        return "";
      constexpr double none = std::numeric_limits<double>::max();
      // smallest and minus largest: of the level, of the pressure
      double range[4] = {none, none, none, none};
      for_each_face(s, [&](const Point<2> &a, const Point<2> &b) {
        for (const Point<2> &x : {a, b})
          {
            const double level = -(s.gravity[0] * x[0] + s.gravity[1] * x[1]) / g, p = s.conditions.value(c, x);
            range[0] = std::min(range[0], level);
            range[1] = std::min(range[1], -level);
            range[2] = std::min(range[2], p);
            range[3] = std::min(range[3], -p);
          }
      });
      MPI_Allreduce(MPI_IN_PLACE, range, 4, MPI_DOUBLE, MPI_MIN, s.space.communicator());
      const double height = -range[0] - range[1], difference = -range[2] - range[3], at_rest = rho * g * height;
      if (range[0] == none || height < 1e-6 * s.size || std::abs(difference) > 0.01 * at_rest)
        return "";
      std::ostringstream text;
      text << "the pressure given on '" << c.name << "' is the same at all its levels, which differ by " << height
           << " m: fluid falls along it, driven by up to " << at_rest
           << " Pa. If its outside is fluid at rest, set Boundary conditions/Add hydrostatic pressure = " << c.name;
      return text.str();
    }
  } // namespace

  ALLUVIUM_REGISTER_BOUNDARY_KIND(
    GivenPressure,
    "Pressure",
    "Boundaries open to a given pressure [Pa] (with its hydrostatic part), as `name: expression; name: expression`. An "
    "expression may use x, y, t and the constants rho (fluid density), g (magnitude of gravity), H (height of the "
    "domain), L (height of the bed at t = 0) and pi, for instance `top: 0; bottom: rho*g*H*(1 + t)`.")
} // namespace alluvium::fluid
