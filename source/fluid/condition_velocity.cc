#include <alluvium/fluid/boundary_scene.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    class GivenVelocityKind : public BoundaryKind<2>
    {
    public:
      Velocity     velocity() const override { return Velocity::given; }
      unsigned int n_values() const override { return 2; }
      std::string  in_words() const override { return "velocity"; }

      /** A velocity that depends on place and is zero wherever its boundary is. */
      std::string check(const BoundaryScene<2> &s) const override
      {
        const auto &c = s.condition;
        if (s.flux != 0. || !(c.may_depend_on("x") || c.may_depend_on("y")) || c.may_depend_on("t"))
          return "";
        double largest = 0., largest_across = 0.; // across: what would be a flux
        for (const auto &face : s.space.boundary().inflow_faces())
          if (face.boundary == s.id)
            for (unsigned int i = 0; i <= 100; ++i)
              {
                const double   part = face.from + 0.01 * i * (face.to - face.from);
                const Point<2> point((1. - part) * face.end[0] + part * face.end[1]);
                Tensor<1, 2>   u;
                for (unsigned int d = 0; d < 2; ++d)
                  u[d] = s.conditions.value(c, point, d);
                largest        = std::max(largest, u.norm());
                largest_across = std::max(largest_across, std::abs(u * face.normal));
              }
        check_user(Utilities::MPI::max(largest, s.space.communicator()) > 0. &&
                     !(Utilities::MPI::max(largest_across, s.space.communicator()) > 0.),
                   "Boundary conditions/Velocity: '" + c.text + "' is zero everywhere on '" + c.name +
                     "': the inlet lies beside it, or is too narrow to be seen. Name it with Domain/Named parts, such "
                     "as `inlet = bottom: 0.014 < x < 0.016`.");
        return "";
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_BOUNDARY_KIND(
    GivenVelocityKind,
    "Velocity",
    "Boundaries with a given velocity [m/s], as `name: u_x | u_y; ...`, each component an expression "
    "as under Pressure.")
} // namespace alluvium::fluid
