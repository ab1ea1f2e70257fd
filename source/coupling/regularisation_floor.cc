#include <alluvium/coupling/drag_regularisation.h>

#include <algorithm>

namespace alluvium::coupling
{
  namespace
  {
    DragState with_void_fraction(DragState state, const double eps)
    {
      state.eps = eps;
      return state;
    }

    class None : public DragRegularisation
    {
    public:
      double gamma(const DragLaw &law, const DragState &state) const override
      {
        return law.gamma(with_void_fraction(state, std::max(state.eps, 1e-6))); // but not infinite
      }
    };

    class Floor : public DragRegularisation
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Minimal void fraction",
                          smallest,
                          "Below this void fraction drag laws see this one.",
                          dealii::Patterns::Double(1e-6, 1.));
      }

      double gamma(const DragLaw &law, const DragState &state) const override
      {
        return law.gamma(with_void_fraction(state, std::max(state.eps, smallest)));
      }

    private:
      double smallest = 0.01;
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_REGULARISATION(None, "none", "The drag law as it is, down to a void fraction of 1e-6.")
  ALLUVIUM_REGISTER_DRAG_REGULARISATION(Floor, "floor", "A smallest void fraction.")
} // namespace alluvium::coupling
