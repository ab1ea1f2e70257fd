#include <alluvium/coupling/drag_dallavalle.h>

#include <deal.II/base/numbers.h>

#include <cmath>

namespace alluvium::coupling
{
  void DallavalleDrag::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Exponent",
      exponent,
      "Exponent of the void fraction: constant (-2.8) or Di Felice's, which depends on the Reynolds number.",
      dealii::Patterns::Selection("constant|Di Felice"));
    prm.add_parameter("Factor", factor, "Multiplies the drag.", dealii::Patterns::Double(0.));
  }


  double DallavalleDrag::gamma(const DragState &s) const
  {
    const double re      = s.reynolds();
    const double bracket = a * std::sqrt(re) + b;
    double       n       = 2.8;
    if (exponent[0] == 'D')
      {
        const double z = 1.5 - std::log10(std::max(re, 1e-30));
        n              = 2.7 - 0.65 * std::exp(-0.5 * z * z);
      }
    return factor * shape * std::pow(s.eps, -n) * bracket * bracket * s.viscosity / (s.diameter * s.diameter);
  }


  namespace
  {
    struct DiscDrag : DallavalleDrag
    {
      DiscDrag()
        : DallavalleDrag(2. / dealii::numbers::PI, 0.63, 4.8)
      {}
    };
    struct StandardSphere : DallavalleDrag
    {
      StandardSphere()
        : DallavalleDrag(0.75, 0.63, 4.8)
      {}
    };
    struct PaperDrag : DallavalleDrag
    {
      PaperDrag()
        : DallavalleDrag(1., 0.77, 5.87)
      {}
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(DiscDrag, "disc", "Dallavalle-Di Felice for a slice of a cylinder across the flow.")
  ALLUVIUM_REGISTER_DRAG_LAW(StandardSphere, "sphere", "Dallavalle-Di Felice for spheres.")
  ALLUVIUM_REGISTER_DRAG_LAW(
    PaperDrag,
    "paper",
    "With the constants 0.77 and 5.87 of the paper's equation (8), squared: twice the sphere's drag.")
} // namespace alluvium::coupling
