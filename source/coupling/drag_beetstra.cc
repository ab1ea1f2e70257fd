#include <alluvium/coupling/sphere_drag.h>

#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * R. Beetstra, M. A. van der Hoef and J. A. M. Kuipers, AIChE J. 53 (2007) 489, for one size: lattice-Boltzmann
     * simulations of random arrays, phi 0.1 to 0.6, Re up to 1000.
     */
    struct Beetstra : SphereDrag
    {
      Beetstra()
        : SphereDrag({0.4, 0.9, 0., 1000.})
      {}
      double force(const double eps, const double re) const override
      {
        const double phi = 1. - eps;
        if (re < 1e-12) // the inertial part goes like Re^1.157 at least
          return creeping_force(eps);
        return creeping_force(eps) + 0.413 * re / (24. * eps * eps) *
                                       (1. / eps + 3. * eps * phi + 8.4 * std::pow(re, -0.343)) /
                                       (1. + std::pow(10., 3. * phi) * std::pow(re, -0.5 * (1. + 4. * phi)));
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(Beetstra,
                             "Beetstra",
                             "Beetstra, van der Hoef and Kuipers (2007), from resolved simulations of spheres.")
} // namespace alluvium::coupling
