#include <alluvium/coupling/sphere_drag.h>

#include <algorithm>

namespace alluvium::coupling
{
  /** S. Ergun, Chem. Eng. Prog. 48 (1952) 89: -grad p = 150 phi^2 eta U / (eps^3 d^2) + 1.75 phi rho U^2 / (eps^3 d).
   */
  double ergun_force(const double eps, const double re)
  {
    return (150. * (1. - eps) + 1.75 * re) / (18. * eps * eps);
  }


  namespace
  {
    /**
     * Ergun's law for packed beds. The range is that of his columns, stretched to the eps = 0.8 to which it is commonly
     * used, and Re / (1 - eps) up to about 2,000. Far beyond, where it would vanish, a lone sphere's Stokes drag is
     * the least.
     */
    struct Ergun : SphereDrag
    {
      Ergun()
        : SphereDrag({0.3, 0.8, 0., 1200.})
      {}
      double force(const double eps, const double re) const override { return std::max(1., ergun_force(eps, re)); }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(Ergun, "Ergun", "Ergun (1952), packed beds of spheres: void fraction to 0.8.")
} // namespace alluvium::coupling
