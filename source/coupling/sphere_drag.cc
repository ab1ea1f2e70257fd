#include <alluvium/coupling/sphere_drag.h>

#include <deal.II/base/numbers.h>

#include <cmath>

namespace alluvium::coupling
{
  void SphereDrag::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Shape",
                      shape,
                      "`sphere`: the law as published, for a bed equivalent to one of spheres; `disc`: for slices of "
                      "cylinders, 8/(3 pi) of it, the ratio of frontal area over volume.",
                      dealii::Patterns::Selection("sphere|disc"));
    prm.add_parameter("Factor", factor, "Multiplies the drag.", dealii::Patterns::Double(0.));
  }


  double SphereDrag::gamma(const DragState &s) const
  {
    const double of_shape = shape == "disc" ? 8. / (3. * dealii::numbers::PI) : 1.;
    return factor * of_shape * 18. * s.viscosity * s.eps * force(s.eps, s.reynolds()) / (s.diameter * s.diameter);
  }


  double creeping_force(const double eps)
  {
    const double phi = 1. - eps;
    return 10. * phi / (eps * eps) + eps * eps * (1. + 1.5 * std::sqrt(phi));
  }
} // namespace alluvium::coupling
