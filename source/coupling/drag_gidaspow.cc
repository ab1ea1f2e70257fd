#include <alluvium/coupling/sphere_drag.h>

namespace alluvium::coupling
{
  namespace
  {
    /** D. Gidaspow, Multiphase flow and fluidization (Academic Press, 1994): Ergun below eps = 0.8, Wen-Yu from there.
     */
    struct Gidaspow : SphereDrag
    {
      Gidaspow()
        : SphereDrag({0.3, 1., 0., 1200.})
      {}
      double force(const double eps, const double re) const override
      {
        return eps < 0.8 ? ergun_force(eps, re) : wen_yu_force(eps, re);
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_DRAG_LAW(Gidaspow,
                             "Gidaspow",
                             "Gidaspow (1994): Ergun's law below a void fraction of 0.8, Wen and Yu's above; it jumps "
                             "there.")
} // namespace alluvium::coupling
