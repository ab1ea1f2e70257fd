#include <alluvium/run/check_void_fraction.h>

namespace alluvium::run
{
  void check_void_fraction(Model &m)
  {
    // all that hold the fluid there are drag, and what it does at other nodes
    constexpr double none = 1e-6;
    if (m.has_fluid && m.grains.n() > 0 && m.coupling.report().eps_min < none)
      m.warnings.add("the void fraction is 0 where cells lie within a grain: only drag holds the fluid there, and where that is "
                     "small, as in a gas, it runs away. Make Coupling/Filter radius larger (1 d or more), or cells",
                     m.time);
  }
} // namespace alluvium::run
