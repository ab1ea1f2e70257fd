#include <alluvium/coupling/sphere_drag.h>

#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * R. J. Hill, D. L. Koch and A. J. C. Ladd, J. Fluid Mech. 448 (2001) 213 and 243; D. L. Koch and R. J. Hill, Annu.
     * Rev. Fluid Mech. 33 (2001) 619: F_0 + F_3 Re_radius, the mean force with the pressure gradient's, so that F is
     * eps times it. Lattice-Boltzmann simulations up to random close packing and Re = 120.
     */
    struct KochHill : SphereDrag
    {
      KochHill()
        : SphereDrag({0.36, 1., 0., 120.})
      {}
      double force(const double eps, const double re) const override
      {
        const double phi = 1. - eps;
        double       f0  = 1.;
        if (phi >= 0.4)
          f0 = 10. * phi / std::pow(eps, 3);
        else if (phi > 0.)
          f0 = (1. + 3. * std::sqrt(0.5 * phi) + 135. / 64. * phi * std::log(phi) + 16.14 * phi) /
               (1. + 0.681 * phi - 8.48 * phi * phi + 8.16 * phi * phi * phi);
        const double f3 = 0.0673 + 0.212 * phi + 0.0232 / std::pow(eps, 5);
        return eps * (f0 + 0.5 * f3 * re);
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(KochHill, "Koch-Hill", "Hill, Koch and Ladd (2001), from resolved simulations of spheres.")
} // namespace alluvium::coupling
