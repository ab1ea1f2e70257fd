#pragma once

#include <alluvium/utilities/plugin.h>

#include <deal.II/base/point.h>

#include <map>
#include <string>

namespace alluvium::fluid
{
  /**
   * Interface of boundary conditions that come as plug-ins: a pressure [Pa] or a velocity [m/s] that is given on a
   * boundary as a function of place and time. The same on all ranks.
   */
  class BoundaryPlugin : public Plugin
  {
  public:
    enum class Gives
    {
      pressure,
      velocity
    };

    virtual Gives gives() const = 0;

    /**
     * Before any value is asked for, and again when the grains are there: @p constants are those of formulas (rho, eta,
     * g, H, L, d). Throws UserError for parameters that are no good.
     */
    virtual void initialize(const std::map<std::string, double> &) {}

    /** Component @p component of the velocity, or the pressure (@p component 0), at @p point and @p time [s]. */
    virtual double value(const dealii::Point<2> &point, double time, unsigned int component) const = 0;
  };
} // namespace alluvium::fluid

/** Register a boundary condition under the name that parameter files use. */
#define ALLUVIUM_REGISTER_BOUNDARY_CONDITION(Class, name, prose)                                                       \
  ALLUVIUM_REGISTER(::alluvium::fluid::BoundaryPlugin, Class, name, prose)
