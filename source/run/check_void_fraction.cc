#include <alluvium/run/check_void_fraction.h>
#include <alluvium/utilities/divergence.h>

namespace alluvium::run
{
  namespace
  {
    // all that hold the fluid there are drag, and what it does at other nodes
    bool grains_leave_no_room(const Model &m)
    {
      constexpr double none = 1e-6;
      return m.has_fluid && m.grains.n() > 0 && m.coupling.report().eps_min < none;
    }

    constexpr const char *remedy = "Make Coupling/Filter radius larger (1 d or more), or cells";
  } // namespace


  void check_void_fraction(Model &m)
  {
    if (grains_leave_no_room(m))
      m.warnings.add(
        std::string(
          "the void fraction is 0 where cells lie within a grain: only drag holds the fluid there, and where that is "
          "small, as in a gas, it runs away. ") +
          remedy,
        m.time);
  }


  void blame_void_fraction(const Model &m)
  {
    if (grains_leave_no_room(m))
      throw Divergence(
        std::string(
          "the fluid's equations cannot be solved, for the void fraction is 0 where cells lie within a grain. ") +
        remedy + ".");
  }
} // namespace alluvium::run
