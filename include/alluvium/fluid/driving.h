#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::fluid
{
  /** A component of what a parameter gives as a function of time. */
  struct FunctionOfTime
  {
    std::string                   parameter, text; // its name, and its value as the user wrote it
    std::function<double(double)> component;
  };

  /** What drives the fluid besides its boundaries: a body force, and a mean pressure gradient in a periodic box. */
  template <int dim>
  class Driving
  {
  public:
    /** Declare the parameters in the section of @p prm that is open. */
    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Parse the formulas, which may use t and @p constants. Throws UserError if they cannot be understood, and for a
     * mean pressure gradient along a direction whose @p periodic_length is 0: there boundaries say what the pressure
     * is.
     */
    void initialize(const std::map<std::string, double> &constants, const std::array<double, dim> &periodic_length);

    /** Throws UserError if a value is not finite then. */
    void set_time(const double time);

    /**
     * Gradient of the pressure that is not in the solution [Pa/m]: that of the fluid at rest, @p hydrostatic_gradient,
     * but in periodic directions, along which a fluid under gravity does not come to rest, the mean that is given.
     */
    dealii::Tensor<1, dim> background_gradient(const dealii::Tensor<1, dim>  &hydrostatic_gradient,
                                               const std::array<double, dim> &periodic_length) const;

    /** Components of body force [N/m^3] and mean pressure gradient [Pa/m] that depend on time [s]. */
    std::vector<FunctionOfTime> functions_of_time() const;

    /** [N/m^3] of fluid */
    const dealii::Tensor<1, dim> &body_force() const { return force; }

  private:
    std::string                            force_text = "0 | 0", gradient_text = "0 | 0";
    std::shared_ptr<dealii::Function<dim>> force_function, gradient_function;
    dealii::Tensor<1, dim>                 force, gradient; // now
  };
} // namespace alluvium::fluid
