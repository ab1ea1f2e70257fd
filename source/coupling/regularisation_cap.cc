#include <alluvium/coupling/drag_regularisation.h>

#include <algorithm>

namespace alluvium::coupling
{
  namespace
  {
    class Cap : public DragRegularisation
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Largest drag",
                          largest,
                          "Largest gamma d^2 / eta. A bed of void fraction 0.48 has about 100, in creeping flow.",
                          dealii::Patterns::Double(1e-6));
      }

      double gamma(const DragLaw &law, const DragState &state) const override
      {
        DragState s = state;
        s.eps       = std::max(s.eps, 1e-6);
        return std::min(law.gamma(s), largest * s.viscosity / (s.diameter * s.diameter));
      }

    private:
      double largest = 1e3;
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_REGULARISATION(Cap, "cap", "A largest drag.")
} // namespace alluvium::coupling
