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
    return "Boundary conditions/" + std::string(of_plugin ? "Plug-ins" : kind->parameter) + ": boundary '" + name + "'";
  }


  template <int dim>
  void BoundaryConditions<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Boundary conditions");
    kinds.create();
    for (const auto &[name, kind] : kinds.all())
      {
        kind->parameter = name;
        prm.add_parameter(name, boundaries[name], Registry<BoundaryKind<dim>>::entries().at(name).prose);
        kind->add_parameters(prm);
      }
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
    plugins.create();
    prose += plugins.empty() ? "None is known; see Additional shared libraries." : "Known are:";
    for (const auto &[name, plugin] : plugins.all())
      prose += "\n'" + name + "': " + Registry<BoundaryPlugin>::entries().at(name).prose;
    prm.add_parameter("Plug-ins", by_plugins, prose);
    plugins.add_parameters(prm, "Plug-ins");
    prm.leave_subsection();
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_parameters()
  {
    for (const auto &[name, list] : boundaries)
      if (!list.empty())
        kinds.parse_parameters(name);
    for (const auto &[boundary, plugin] : plugins_by_boundary())
      plugins.parse_parameters(plugin);
  }


  template <int dim>
  std::vector<std::pair<std::string, std::string>> BoundaryConditions<dim>::plugins_by_boundary() const
  {
    const std::string                                where = "Boundary conditions/Plug-ins: ";
    const std::string                                known = plugins.names(", ");
    std::vector<std::pair<std::string, std::string>> result;
    for (const auto &item : Utilities::split_string_list(by_plugins, ';'))
      {
        const auto colon = item.find(':');
        check_user(colon != std::string::npos, where + "expected `name: plug-in`, got '" + item + "'.");
        const std::string plugin = Utilities::trim(item.substr(colon + 1));
        check_user(plugins.contains(plugin),
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

    for (const auto &[parameter, kind] : kinds.all())
      for (const auto &item : Utilities::split_string_list(boundaries.at(parameter), kind->n_values() == 0 ? ',' : ';'))
        if (kind->n_values() == 0)
          add(parameter, item, {kind, item, nullptr});
        else
          {
            const auto        colon = item.find(':');
            const std::string where = "Boundary conditions/" + parameter;
            check_user(colon != std::string::npos, where + ": expected `name: expression`, got '" + item + "'.");
            const std::string name = Utilities::trim(item.substr(0, colon));
            const std::string text = Utilities::trim(item.substr(colon + 1));
            add(parameter,
                name,
                {kind, name, parse_function(where + ": boundary '" + name + "'", text, kind->n_values()), text});
          }

    for (const auto &[name, plugin_name] : plugins_by_boundary())
      {
        const auto &plugin = plugins.get(plugin_name);
        plugin->initialize(constants);
        const auto &kind = kinds.get(plugin->gives() == BoundaryPlugin::Gives::pressure ? "Pressure" : "Velocity");
        Condition   condition{kind, name, nullptr, plugin_name};
        condition.value     = std::make_shared<PluginFunction>(plugin, kind->n_values());
        condition.of_plugin = true;
        add("Plug-ins", name, condition);
      }

    for (const auto &name : Utilities::split_string_list(hydrostatic))
      {
        const auto it = ids.find(name);
        check_user(it != ids.end() && conditions.count(it->second) && conditions.at(it->second).kind->gives_pressure(),
                   "Boundary conditions/Add hydrostatic pressure: '" + name +
                     "' is no boundary with a given pressure.");
        conditions.at(it->second).add_hydrostatic = true;
      }

    for (const auto &[name, id] : ids)
      check_user(conditions.count(id) == 1,
                 "Boundary conditions: boundary '" + name + "' has none. Name it under one of " +
                   kinds.names(", ", true) + ", 'Plug-ins'.");
    check_user(
      pin_pressure || fixes_pressure(),
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
    double     value     = condition.value->value(point, component);
    const bool is_finite = std::isfinite(value);
    if (!is_finite || !condition.kind->allows(component, value))
      {
        std::ostringstream text;
        text << condition.described() << ": '" << condition.text << "' is " << value << " at x = " << point[0]
             << ", y = " << point[1] << ", t = " << time << "; expected "
             << (is_finite ? condition.kind->expected() : "a finite number") << '.';
        throw UserError(text.str());
      }
    if (condition.add_hydrostatic && component == 0)
      value += hydrostatic_gradient * (point - hydrostatic_origin);
    return value;
  }


  template <int dim>
  bool BoundaryConditions<dim>::velocity_depends_on_time() const
  {
    return std::any_of(conditions.begin(), conditions.end(), [](const auto &entry) {
      const Condition &c = entry.second;
      return c.kind->velocity() == BoundaryKind<dim>::Velocity::given && c.may_depend_on("t");
    });
  }


  template <int dim>
  bool BoundaryConditions<dim>::terms_depend_on_time() const
  {
    return std::any_of(conditions.begin(), conditions.end(), [](const auto &entry) {
      const Condition &c = entry.second;
      return c.value && c.kind->has_terms() && !c.kind->gives_pressure() &&
             c.kind->velocity() != BoundaryKind<dim>::Velocity::given && c.may_depend_on("t");
    });
  }


  template <int dim>
  bool BoundaryConditions<dim>::fixes_pressure() const
  {
    return std::any_of(
      conditions.begin(), conditions.end(), [](const auto &entry) { return entry.second.kind->fixes_pressure(); });
  }


  template <int dim>
  void BoundaryConditions<dim>::set_hydrostatic_pressure(const Tensor<1, dim> &gradient, const Point<dim> &origin)
  {
    hydrostatic_gradient = gradient;
    hydrostatic_origin   = origin;
  }


  template class BoundaryConditions<2>;
} // namespace alluvium::fluid
