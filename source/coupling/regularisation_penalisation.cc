#include <alluvium/coupling/drag_regularisation.h>

#include <algorithm>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * The drag law down to a void fraction that no packing is below; further down, where the mesh sees the inside of a
     * grain, it passes smoothly into the volume penalisation of Angot, Bruneau and Fabrie (Numer. Math. 81, 1999): the
     * grain is a porous body of permeability K d^2, in which nothing moves but it.
     */
    class Penalisation : public DragRegularisation
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Void fraction",
                          threshold,
                          "From which void fraction downward the drag law passes into penalisation.",
                          dealii::Patterns::Double(1e-3, 1.));
        prm.add_parameter("Permeability",
                          permeability,
                          "Of the inside of a grain, over its diameter squared.",
                          dealii::Patterns::Double(1e-12));
      }

      double gamma(const DragLaw &law, const DragState &state) const override
      {
        DragState s    = state;
        s.eps          = std::max(s.eps, threshold);
        const double x = 1. - std::min(1., std::max(0., state.eps) / threshold), weight = x * x * (3. - 2. * x);
        return (1. - weight) * law.gamma(s) + weight * s.viscosity / (permeability * s.diameter * s.diameter);
      }

    private:
      double threshold = 0.2, permeability = 1e-5;
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_REGULARISATION(Penalisation,
                                        "penalisation",
                                        "Passes into volume penalisation at low void fractions.")
} // namespace alluvium::coupling
