#include <alluvium/coupling/sphere_drag.h>

#include <algorithm>
#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * Y. Tang, E. A. J. F. Peters, J. A. M. Kuipers, S. H. L. Kriebitzsch and M. A. van der Hoef, AIChE J. 61 (2015)
     * 688: immersed-boundary simulations of static arrays, phi up to 0.6, Re up to 1000. Their inertial part becomes
     * negative far above that; here its slope is kept from Re = 1000 on.
     */
    struct Tang : SphereDrag
    {
      Tang()
        : SphereDrag({0.4, 1., 0., 1000.})
      {}
      double force(const double eps, const double re) const override
      {
        const double phi = 1. - eps, eps4 = std::pow(eps, 4), known = std::min(re, 1000.);
        const double inertial =
          known * (0.11 * phi * (1. + phi) - 0.00456 / eps4) + std::pow(known, 0.657) * (0.169 * eps + 0.0644 / eps4);
        return creeping_force(eps) + (re > known ? inertial * re / known : inertial);
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(Tang, "Tang", "Tang and others (2015), from resolved simulations of spheres.")
} // namespace alluvium::coupling
