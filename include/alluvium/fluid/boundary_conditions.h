#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>

#include <map>
#include <memory>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::fluid
{
  /**
   * What happens on each named part of the boundary: wall without slip, wall with slip (= symmetry), given
   * pressure, or given velocity; the latter two as functions of x and t.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    enum class Kind
    {
      no_slip,
      slip,
      pressure,
      velocity,
      natural // no net flux of the mixture, no viscous traction: the ends of a homogeneous suspension in tests
    };
    struct Condition
    {
      Kind                                   kind;
      std::string                            name;
      std::shared_ptr<dealii::Function<dim>> value; // pressure: 1 component [Pa]; velocity: dim components [m/s]
    };

    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Resolve the parsed names and expressions. @p ids maps boundary names to ids; @p constants are names that
     * expressions may use (rho, g, H, L, pi, ...). Throws UserError for a name that the mesh has not, a boundary with
     * no or two conditions, or a pressure that is nowhere fixed.
     */
    void initialize(const std::map<std::string, dealii::types::boundary_id> &ids,
                    const std::map<std::string, double>                     &constants);

    /** Use @p condition on boundary @p id; for programs that have no parameter file. */
    void set(const dealii::types::boundary_id id, const Condition &condition) { conditions[id] = condition; }

    void set_time(const double time);

    const std::map<dealii::types::boundary_id, Condition> &all() const { return conditions; }

    /** Is the pressure fixed at one node instead of on a boundary (closed box)? */
    bool pins_pressure() const { return pin_pressure; }
    void pin(const bool yes) { pin_pressure = yes; }

    /** Are given pressures total ones, p + rho u^2/2, where the flow enters? Static ones otherwise. */
    bool total_pressure_on_inflow() const { return pressure_on_inflow == "total"; }

  private:
    std::string no_slip, slip, symmetric, pressure, velocity;
    std::string pressure_on_inflow = "static";
    bool        pin_pressure       = false;

    std::map<dealii::types::boundary_id, Condition> conditions;
  };
} // namespace alluvium::fluid
