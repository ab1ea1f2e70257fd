#pragma once

#include <alluvium/fluid/boundary_kind.h>
#include <alluvium/fluid/boundary_plugin.h>

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::fluid
{
  /** What happens on each named part of the boundary: a BoundaryKind, and its values as functions of x and t. */
  template <int dim>
  class BoundaryConditions
  {
  public:
    struct Condition
    {
      std::shared_ptr<const BoundaryKind<dim>> kind; // for programs that have no parameter file: see boundary_kind()
      std::string                              name;
      std::shared_ptr<dealii::Function<dim>>   value; // as many components as the kind has values

      std::string text            = "";    // of the values, as the user wrote it
      bool        add_hydrostatic = false; // is the pressure to be added to that of the fluid at rest?
      bool        of_plugin       = false; // then `text` is its name

      /** May the value depend on @p variable, x, y or t? A formula says so, others do not. */
      bool may_depend_on(const std::string &variable) const;

      /** May the value have jumps? As above. */
      bool may_jump() const;

      /** The parameter that gives the value, and the boundary, for messages. */
      std::string described() const;
    };

    void add_parameters(dealii::ParameterHandler &prm);

    /** After the file was read; see Plugin. Throws UserError. */
    void parse_parameters();

    /**
     * Resolve the parsed names and expressions. @p ids maps boundary names to ids; @p constants are names that
     * expressions may use (rho, g, H, L, pi, ...). Throws UserError for a name that the mesh has not, a boundary with
     * no or two conditions, or a pressure that is nowhere fixed.
     */
    void initialize(const std::map<std::string, dealii::types::boundary_id> &ids,
                    const std::map<std::string, double>                     &constants);

    /** Use @p condition on boundary @p id; for programs that have no parameter file. */
    void set(const dealii::types::boundary_id id, const Condition &condition) { conditions[id] = condition; }

    void   set_time(const double time);
    double current_time() const { return time; }

    /**
     * The value of @p condition, which has one, at @p point and the time that is set. Throws UserError if it is not
     * finite.
     */
    double value(const Condition &condition, const dealii::Point<dim> &point, const unsigned int component = 0) const;

    /** Do given velocities depend on time? */
    bool velocity_depends_on_time() const;

    /** Do values that are neither a pressure nor a velocity depend on time? */
    bool terms_depend_on_time() const;

    /** Is a given velocity that of the fluid between the grains? Else it is that of the mixture, a flux by area. */
    bool velocity_is_interstitial() const { return given_velocity == "interstitial"; }
    void give_interstitial_velocity() { given_velocity = "interstitial"; }

    /** Does a boundary say how high the pressure is? */
    bool fixes_pressure() const;

    /**
     * Of the fluid at rest: @p gradient is rho g [Pa/m], and the pressure vanishes at @p origin. It is added to the
     * pressures that want it.
     */
    void set_hydrostatic_pressure(const dealii::Tensor<1, dim> &gradient, const dealii::Point<dim> &origin);

    const std::map<dealii::types::boundary_id, Condition> &all() const { return conditions; }

    /** Is the pressure fixed at one node instead of on a boundary (closed box)? */
    bool pins_pressure() const { return pin_pressure && !fixes_pressure(); }
    void pin(const bool yes) { pin_pressure = yes; }

    /** Are given pressures total ones, p + rho u^2/2, where the flow enters? Static ones otherwise. */
    bool total_pressure_on_inflow() const { return pressure_on_inflow == "total"; }

  private:
    /** Where a plug-in gives the value: its name by the boundary's. Throws UserError. */
    std::vector<std::pair<std::string, std::string>> plugins_by_boundary() const;

    std::string hydrostatic, by_plugins;

    PluginSet<BoundaryKind<dim>>       kinds;
    std::map<std::string, std::string> boundaries; // of each kind, as the user wrote it
    PluginSet<BoundaryPlugin>          plugins;

    std::string given_velocity     = "superficial";
    std::string pressure_on_inflow = "static";
    bool        pin_pressure       = false;
    double      time               = 0.; // [s]

    dealii::Tensor<1, dim> hydrostatic_gradient; // [Pa/m]
    dealii::Point<dim>     hydrostatic_origin;

    std::map<dealii::types::boundary_id, Condition> conditions;
  };
} // namespace alluvium::fluid
