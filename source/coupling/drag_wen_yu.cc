#include <alluvium/coupling/sphere_drag.h>

#include <cmath>

namespace alluvium::coupling
{
  /**
   * C. Y. Wen and Y. H. Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966) 100: a lone sphere's drag (Schiller and Naumann; C_D
   * = 0.44 from Re = 1000 on) times eps^-3.65 at the superficial slip.
   */
  double wen_yu_force(const double eps, const double re)
  {
    const double lone = re < 1000. ? 1. + 0.15 * std::pow(re, 0.687) : 0.44 * re / 24.;
    return lone * std::pow(eps, -3.65);
  }


  namespace
  {
    struct WenYu : SphereDrag
    {
      WenYu()
        : SphereDrag({0.4, 1., 0., 1e4})
      {}
      double force(const double eps, const double re) const override { return wen_yu_force(eps, re); }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(WenYu, "Wen-Yu", "Wen and Yu (1966), fluidised beds and suspensions of spheres.")
} // namespace alluvium::coupling
