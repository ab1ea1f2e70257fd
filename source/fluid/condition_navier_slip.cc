#include <alluvium/fluid/face_state.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /**
     * A wall along which fluid slips the faster the more it is sheared (Navier 1823): u.n = 0, and the tangential
     * velocity is the slip length times its derivative towards the inside. So the wall's traction is -eta/length u_t.
     */
    class NavierSlip : public BoundaryKind<2>
    {
    public:
      Velocity     velocity() const override { return Velocity::no_flow_through; }
      unsigned int n_values() const override { return 1; }
      std::string  in_words() const override { return "slip length"; }
      bool         allows(const unsigned int, const double length) const override { return length > 0.; }
      std::string  expected() const override { return "a slip length above 0; for 0 use 'No-slip walls'"; }
      bool         has_terms() const override { return true; }

      void add_terms(const FaceState<2> &state, FaceTerms<2> &terms) const override
      {
        for (unsigned int q = 0; q < state.n_q_points(); ++q)
          {
            const auto         &phi    = state.face.phi[q];
            const Tensor<1, 2> &normal = state.face.normal[q];
            const double        friction =
              state.face.jxw[q] * state.void_fraction(q) * state.problem.fluid.viscosity / state.value(q);
            for (unsigned int i = 0; i < state.n_nodes(); ++i)
              for (unsigned int j = 0; j < state.n_nodes(); ++j)
                for (unsigned int c = 0; c < 2; ++c)
                  for (unsigned int d = 0; d < 2; ++d)
                    terms.matrix[FaceTerms<2>::row(i, c)][FaceTerms<2>::row(j, d)] +=
                      friction * phi[i] * phi[j] * ((c == d) - normal[c] * normal[d]);
          }
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_BOUNDARY_KIND(
    NavierSlip,
    "Navier slip",
    "Walls along which the fluid slips at the slip length [m] times its shear rate, as `name: slip length; ...`, an "
    "expression as under Pressure. It is the depth behind the wall at which a linear profile would vanish: 0 would be "
    "a no-slip wall, an infinite one a slip wall.")
} // namespace alluvium::fluid
