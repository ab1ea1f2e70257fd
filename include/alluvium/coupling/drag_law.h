#pragma once

#include <alluvium/utilities/plugin.h>

namespace alluvium::coupling
{
  /** What a drag law may know at one piece of a grain. */
  struct DragState
  {
    double eps;       // void fraction
    double slip;      // |u - v|, interstitial [m/s]
    double diameter;  // the fluid's view of the grain [m]
    double density;   // of the fluid [kg/m^3]
    double viscosity; // of the fluid [Pa s]
  };

  /**
   * Interface of the drag closures: f_drag = gamma (u - v), a force density per volume of grain (model A: the pressure
   * gradient acts on the grain besides).
   */
  class DragLaw
  {
  public:
    virtual ~DragLaw() = default;
    virtual void add_parameters(dealii::ParameterHandler &) {}

    /** gamma [N s/m^4]. */
    virtual double gamma(const DragState &state) const = 0;
  };
} // namespace alluvium::coupling

/** Register a drag law under the name that parameter files use; see doc/architecture.md. */
#define ALLUVIUM_REGISTER_DRAG_LAW(Class, name, prose)                                                                 \
  ALLUVIUM_REGISTER(::alluvium::coupling::DragLaw, Class, name, prose)
