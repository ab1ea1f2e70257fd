#include <alluvium/fluid/driving.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <cstdlib>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    const std::string force_name = "Fluid/Body force", gradient_name = "Fluid/Mean pressure gradient";
  }


  template <int dim>
  void Driving<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Body force",
                      force_text,
                      "Force on the fluid, not on the grains, per volume of fluid [N/m^3], as `f_x | f_y`, expressions "
                      "in t and constants as in Boundary conditions. Gravity is not part of it.");
    prm.add_parameter(
      "Mean pressure gradient",
      gradient_text,
      "Gradient of the mean pressure along periodic directions [Pa/m], as `dp/dx | dp/dy`, expressions as "
      "for the body force: -10 | 0 drives the flow to the right. It acts on fluid and grains as any "
      "pressure does. Across a periodic direction the pressure of the fluid at rest cannot build up: "
      "gravity along it drives the flow, and only this gradient can hold it.");
  }


  namespace
  {
    bool is_zero(const std::string &text)
    {
      char        *end   = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      return end != text.c_str() && *end == '\0' && value == 0.;
    }
  } // namespace


  template <int dim>
  void Driving<dim>::initialize(const std::map<std::string, double> &constants,
                                const std::array<double, dim>       &periodic_length)
  {
    const auto parse = [&](const std::string &where, const std::string &text) {
      const auto components = Utilities::split_string_list(text, '|');
      check_user(components.size() == dim,
                 where + ": expected " + std::to_string(dim) + " expressions separated by '|', got '" + text + "'.");
      for (const auto &component : components)
        check_user(!mentions(component, "x") && !mentions(component, "y"),
                   where + ": '" + component + "' must not depend on place.");
      return parse_expressions(where, components, constants);
    };
    force_function        = parse(force_name, force_text);
    gradient_function     = parse(gradient_name, gradient_text);
    const auto components = Utilities::split_string_list(gradient_text, '|');
    for (unsigned int d = 0; d < dim; ++d)
      check_user(periodic_length[d] > 0. || is_zero(components[d]),
                 gradient_name + ": " + "xy"[d] +
                   " is no periodic direction: pressures on boundaries, or Fluid/Body force, drive the flow there.");
    set_time(0.);
  }


  template <int dim>
  void Driving<dim>::set_time(const double time)
  {
    if (!force_function)
      return;
    force_function->set_time(time);
    gradient_function->set_time(time);
    for (unsigned int d = 0; d < dim; ++d)
      {
        force[d]    = force_function->value({}, d);
        gradient[d] = gradient_function->value({}, d);
        check_user(std::isfinite(force[d]) && std::isfinite(gradient[d]),
                   (std::isfinite(force[d]) ? gradient_name + ": '" + gradient_text : force_name + ": '" + force_text) +
                     "' is not finite at t = " + in_digits(time) + " s.");
      }
  }


  template <int dim>
  std::vector<FunctionOfTime> Driving<dim>::functions_of_time() const
  {
    std::vector<FunctionOfTime> result;
    const auto                  add =
      [&](const std::string &parameter, const std::string &text, const std::shared_ptr<Function<dim>> &function) {
        if (!function || !mentions(text, "t"))
          return;
        for (unsigned int d = 0; d < dim; ++d)
          result.push_back({parameter, text, [function, d](const double t) {
                              const double now = function->get_time();
                              function->set_time(t);
                              const double value = function->value({}, d);
                              function->set_time(now);
                              return value;
                            }});
      };
    add(force_name, force_text, force_function);
    add(gradient_name, gradient_text, gradient_function);
    return result;
  }


  template <int dim>
  Tensor<1, dim> Driving<dim>::background_gradient(const Tensor<1, dim>          &hydrostatic_gradient,
                                                   const std::array<double, dim> &periodic_length) const
  {
    Tensor<1, dim> result = hydrostatic_gradient;
    for (unsigned int d = 0; d < dim; ++d)
      if (periodic_length[d] > 0.)
        result[d] = gradient[d];
    return result;
  }


  template class Driving<2>;
} // namespace alluvium::fluid
