#pragma once

#include <alluvium/utilities/plugin.h>

#include <limits>

namespace alluvium::coupling
{
  /** What a drag law may know at one piece of a grain, its intersection with a cell. */
  struct DragState
  {
    double eps;       // void fraction
    double slip;      // |u - v|, interstitial [m/s]
    double diameter;  // the fluid's view of the grain [m]
    double density;   // of the fluid [kg/m^3]
    double viscosity; // of the fluid [Pa s]

    /** Reynolds number of the superficial slip, rho d eps |u - v| / eta. */
    double reynolds() const { return eps * density * diameter * slip / viscosity; }
  };

  /** Where a drag law rests on data; outside it is an extrapolation. */
  struct DragRange
  {
    double eps_min = 0., eps_max = 1.;                                    // void fraction
    double re_min = 0., re_max = std::numeric_limits<double>::infinity(); // DragState::reynolds()

    bool contains(const double eps, const double re) const
    {
      const double round_off = 1e-9; // of means over pieces
      return eps >= eps_min - round_off && eps <= eps_max + round_off && re >= re_min && re <= re_max;
    }
  };

  /**
   * Interface of the drag closures: f_drag = gamma (u - v), a force density per volume of grain (model A: the pressure
   * gradient acts on the grain besides).
   */
  class DragLaw : public Plugin
  {
  public:
    /** gamma [N s/m^4]: above zero and finite for eps in [0.05, 1] and any slip. */
    virtual double gamma(const DragState &state) const = 0;

    /** By default everywhere. */
    virtual DragRange range() const { return {}; }
  };
} // namespace alluvium::coupling

/** Register a drag law under the name that parameter files use; see doc/developer/plug-ins.md. */
#define ALLUVIUM_REGISTER_DRAG_LAW(Class, name, prose)                                                                 \
  ALLUVIUM_REGISTER(::alluvium::coupling::DragLaw, Class, name, prose)
