#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** A plug-in as deal.II's functions are. */
    class PluginFunction : public Function<2>
    {
    public:
      PluginFunction(std::shared_ptr<const BoundaryPlugin> plug_in, const unsigned int n_components)
        : Function<2>(n_components)
        , plugin(std::move(plug_in))
      {}

      double value(const Point<2> &point, const unsigned int component = 0) const override
      {
        return plugin->value(point, this->get_time(), component);
      }

    private:
      const std::shared_ptr<const BoundaryPlugin> plugin;
    };
  } // namespace


  template <int dim>
  bool BoundaryConditions<dim>::Condition::may_depend_on(const std::string &variable) const
  {
    return text.empty() || of_plugin || mentions(text, variable);
  }


  template <int dim>
  bool BoundaryConditions<dim>::Condition::may_jump() const
  {
    // components are divided by '|', which is no operator here
    constexpr std::array<const char *, 11> jumping = {
      {"if", "rint", "int", "floor", "ceil", "sign", "abs", "min", "max", "rand", "rand_seed"}};
    return text.empty() || of_plugin || text.find_first_of("<>?=!&%") != std::string::npos ||
           std::any_of(jumping.begin(), jumping.end(), [&](const char *word) { return mentions(text, word); });
  }


  template <int dim>
  std::string BoundaryConditions<dim>::Condition::described() const
  {
    return std::string("Boundary conditions/") +
           (of_plugin                ? "Plug-ins"
            : kind == Kind::pressure ? "Pressure"
                                     : "Velocity") +
           ": boundary '" + name + "'";
  }


  template <int dim>
  void BoundaryConditions<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Boundary conditions");
    prm.add_parameter("No-slip walls",
                      no_slip,
                      "Names of the boundaries on which the fluid sticks: u = 0. Separated by commas. A rectangle's "
                      "boundaries are left, right, bottom and top; a mesh file's are its physical groups.");
    prm.add_parameter("Slip walls", slip, "Names of the impermeable boundaries without wall shear: u.n = 0.");
    prm.add_parameter(
      "Symmetric",
      symmetric,
      "Names of the symmetry lines: u.n = 0 and no shear, in this formulation the same as a slip wall.");
    prm.add_parameter("Pressure",
                      pressure,
                      "Boundaries open to a given pressure [Pa] (with its hydrostatic part), as `name: expression; "
                      "name: expression`. An "
                      "expression may use x, y, t "
                      "and the constants rho (fluid density), g (magnitude of gravity), H (height of the domain), L "
                      "(height of the bed at "
                      "t = 0) and pi, for instance `top: 0; bottom: rho*g*H*(1 + t)`.");
    prm.add_parameter("Velocity",
                      velocity,
                      "Boundaries with a given velocity [m/s], as `name: u_x | u_y; ...`, each component an expression "
                      "as under Pressure.");
    prm.add_parameter(
      "Given velocity",
      given_velocity,
      "What a given velocity is. `superficial`: that of the mixture, a flux by area: what enters is its integral over "
      "the "
      "boundary, whatever grains lie there and however large the cells are; the fluid between the grains is the "
      "faster. "
      "`interstitial`: that of the fluid between the grains; the flux is the less the more grains there are.",
      Patterns::Selection("superficial|interstitial"));
    prm.add_parameter(
      "Add hydrostatic pressure",
      hydrostatic,
      "Names of boundaries under Pressure to whose pressure that of the fluid at rest is added, which vanishes at the "
      "domain's highest level: with `left: 12.8; right: 0` and both named here, 12.8 Pa drive the flow at every level. "
      "Without it the given pressure is all there is.");
    prm.add_parameter(
      "Pressure on inflow",
      pressure_on_inflow,
      "What a given pressure is where the flow enters. `static`: the pressure on the boundary, as if the flow outside "
      "were as developed as that inside: a stream or a pipe goes on. `total`: p + rho U^2/2, with U^2 the mean of "
      "u_n^2 "
      "over what enters: it comes from fluid at rest (a reservoir). What comes back through a boundary by which "
      "more leaves than enters is taken from fluid at rest in both cases; where flow leaves, it is the static "
      "pressure.",
      Patterns::Selection("static|total"));
    prm.add_parameter(
      "Pin pressure",
      pin_pressure,
      "In a box closed all around, fix the pressure at one node (its level is arbitrary there). Where a "
      "boundary has a pressure this does nothing.");
    std::string prose = "Boundaries whose pressure or velocity a plug-in gives, as `name: plug-in; name: plug-in`. ";
    if (plugins.empty())
      for (const auto &[name, entry] : Registry<BoundaryPlugin>::entries())
        plugins.emplace(name, entry.create());
    prose += plugins.empty() ? "None is known; see Additional shared libraries." : "Known are:";
    for (const auto &[name, plugin] : plugins)
      prose += "\n'" + name + "': " + Registry<BoundaryPlugin>::entries().at(name).prose;
    prm.add_parameter("Plug-ins", by_plugins, prose);
    for (const auto &[name, plugin] : plugins)
      {
        prm.enter_subsection("Plug-ins: " + name);
        plugin->add_parameters(prm);
        prm.leave_subsection();
      }
    prm.leave_subsection();
  }


  template <int dim>
  std::vector<std::pair<std::string, std::string>> BoundaryConditions<dim>::plugins_by_boundary() const
  {
    const std::string where = "Boundary conditions/Plug-ins: ";
    std::string       known;
    for (const auto &[name, plugin] : plugins)
      known += (known.empty() ? "" : ", ") + name;
    std::vector<std::pair<std::string, std::string>> result;
    for (const auto &item : Utilities::split_string_list(by_plugins, ';'))
      {
        const auto colon = item.find(':');
        check_user(colon != std::string::npos, where + "expected `name: plug-in`, got '" + item + "'.");
        const std::string plugin = Utilities::trim(item.substr(colon + 1));
        check_user(plugins.count(plugin) > 0,
                   where + "there is no boundary condition named '" + plugin + "'; " +
                     (known.empty() ? "none is known. Is its library under 'Additional shared libraries'?"
                                    : "known are: " + known + "."));
        result.emplace_back(Utilities::trim(item.substr(0, colon)), plugin);
      }
    return result;
  }


  template <int dim>
  void BoundaryConditions<dim>::initialize(const std::map<std::string, types::boundary_id> &ids,
                                           const std::map<std::string, double>             &constants)
  {
    conditions.clear();
    std::string known;
    for (const auto &[name, id] : ids)
      known += (known.empty() ? "" : ", ") + name;

    const auto add = [&](const std::string &parameter, const std::string &name, const Condition &condition) {
      const auto it = ids.find(name);
      check_user(it != ids.end(),
                 "Boundary conditions/" + parameter + ": there is no boundary named '" + name +
                   "'. The domain's boundaries are: " + known + ".");
      check_user(conditions.count(it->second) == 0,
                 "Boundary conditions/" + parameter + ": boundary '" + name + "' already has another condition.");
      conditions[it->second] = condition;
    };
    const auto parse_function =
      [&](const std::string &where, const std::string &text, const unsigned int n_components) {
        const std::vector<std::string> components = Utilities::split_string_list(text, '|');
        check_user(components.size() == n_components,
                   where + ": expected " + std::to_string(n_components) + " expression(s) separated by '|', got '" +
                     text + "'.");
        return parse_expressions(where, components, constants);
      };

    for (const auto &name : Utilities::split_string_list(no_slip))
      add("No-slip walls", name, {Kind::no_slip, name, nullptr});
    for (const auto &name : Utilities::split_string_list(slip))
      add("Slip walls", name, {Kind::slip, name, nullptr});
    for (const auto &name : Utilities::split_string_list(symmetric))
      add("Symmetric", name, {Kind::slip, name, nullptr});
    for (const auto &[parameter, text, kind, n_components] :
         {std::make_tuple("Pressure", pressure, Kind::pressure, 1u),
          std::make_tuple("Velocity", velocity, Kind::velocity, 0u + dim)})
      for (const auto &item : Utilities::split_string_list(text, ';'))
        {
          const auto        colon = item.find(':');
          const std::string where = std::string("Boundary conditions/") + parameter;
          check_user(colon != std::string::npos, where + ": expected `name: expression`, got '" + item + "'.");
          const std::string name = Utilities::trim(item.substr(0, colon));
          const std::string text = Utilities::trim(item.substr(colon + 1));
          add(parameter,
              name,
              {kind, name, parse_function(where + ": boundary '" + name + "'", text, n_components), text});
        }

    for (const auto &[name, plugin_name] : plugins_by_boundary())
      {
        const auto &plugin = plugins.at(plugin_name);
        plugin->initialize(constants);
        const bool is_pressure = plugin->gives() == BoundaryPlugin::Gives::pressure;
        Condition  condition{is_pressure ? Kind::pressure : Kind::velocity, name, nullptr, plugin_name};
        condition.value     = std::make_shared<PluginFunction>(plugin, is_pressure ? 1u : 0u + dim);
        condition.of_plugin = true;
        add("Plug-ins", name, condition);
      }

    for (const auto &name : Utilities::split_string_list(hydrostatic))
      {
        const auto it = ids.find(name);
        check_user(it != ids.end() && conditions.count(it->second) && conditions.at(it->second).kind == Kind::pressure,
                   "Boundary conditions/Add hydrostatic pressure: '" + name +
                     "' is no boundary with a given pressure.");
        conditions.at(it->second).add_hydrostatic = true;
      }

    bool pressure_is_fixed = pin_pressure;
    for (const auto &[name, id] : ids)
      {
        check_user(conditions.count(id) == 1,
                   "Boundary conditions: boundary '" + name +
                     "' has none. Name it under 'No-slip walls', 'Slip walls', 'Symmetric', 'Pressure', 'Velocity' or "
                     "'Plug-ins'.");
        pressure_is_fixed = pressure_is_fixed || conditions.at(id).kind == Kind::pressure;
      }
    check_user(
      pressure_is_fixed,
      "Boundary conditions: the pressure is fixed nowhere. Give it on a boundary under 'Pressure', or, in a box closed "
      "all around, set 'Pin pressure = true'.");
    set_time(0.);
  }


  template <int dim>
  void BoundaryConditions<dim>::set_time(const double new_time)
  {
    time = new_time;
    for (auto &[id, condition] : conditions)
      if (condition.value)
        condition.value->set_time(time);
  }


  template <int dim>
  double BoundaryConditions<dim>::value(const Condition   &condition,
                                        const Point<dim>  &point,
                                        const unsigned int component) const
  {
    double value = condition.value->value(point, component);
    if (!std::isfinite(value))
      {
        std::ostringstream text;
        text << condition.described() << ": '" << condition.text << "' is " << value << " at x = " << point[0]
             << ", y = " << point[1] << ", t = " << time << "; expected a finite number.";
        throw UserError(text.str());
      }
    if (condition.add_hydrostatic)
      value += hydrostatic_gradient * (point - hydrostatic_origin);
    return value;
  }


  template <int dim>
  bool BoundaryConditions<dim>::velocity_depends_on_time() const
  {
    return std::any_of(conditions.begin(), conditions.end(), [](const auto &entry) {
      const Condition &c = entry.second;
      return c.kind == Kind::velocity && c.may_depend_on("t");
    });
  }


  template <int dim>
  bool BoundaryConditions<dim>::has_pressure() const
  {
    return std::any_of(
      conditions.begin(), conditions.end(), [](const auto &entry) { return entry.second.kind == Kind::pressure; });
  }


  template <int dim>
  void BoundaryConditions<dim>::set_hydrostatic_pressure(const Tensor<1, dim> &gradient, const Point<dim> &origin)
  {
    hydrostatic_gradient = gradient;
    hydrostatic_origin   = origin;
  }


  template class BoundaryConditions<2>;
} // namespace alluvium::fluid
