#include <alluvium/coupling/sphere_drag.h>

#include <algorithm>
#include <cmath>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * L. W. Rong, K. J. Dong and A. B. Yu, Chem. Eng. Sci. 99 (2013) 44: Dallavalle's coefficient with an exponent that
     * depends on the void fraction, too,
     *   beta = 2.65 (eps + 1) - (5.3 - 3.5 eps) eps^2 exp(-(1.5 - log10 Re)^2 / 2),
     * from lattice-Boltzmann simulations of packed beds.
     */
    struct Rong : SphereDrag
    {
      Rong()
        : SphereDrag({0.37, 0.8, 0., 1000.})
      {}
      double force(const double eps, const double re) const override
      {
        const double z = 1.5 - std::log10(std::max(re, 1e-30)), bracket = 0.63 * std::sqrt(re) + 4.8;
        const double beta = 2.65 * (eps + 1.) - (5.3 - 3.5 * eps) * eps * eps * std::exp(-0.5 * z * z);
        return bracket * bracket / 24. * std::pow(eps, -beta);
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(Rong, "Rong", "Rong, Dong and Yu (2013), from resolved simulations of packed beds.")
} // namespace alluvium::coupling
