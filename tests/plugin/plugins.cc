// Plug-ins that only this library knows, for tests: what somebody has who brings their own. One more, a kind of boundary
// condition, is in fixtures/leaky_wall.h.
#include "fixtures/leaky_wall.h"

#include <alluvium/coupling/drag_law.h>
#include <alluvium/fluid/boundary_plugin.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <stdexcept>

namespace
{
  class LinearDrag : public alluvium::coupling::DragLaw
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Resistance", resistance, "The same drag everywhere [N s/m^4].", dealii::Patterns::Double(0.));
      prm.add_parameter("Failing rank", failing_rank, "This rank has an error in the end [-]. -1: none.");
      prm.add_parameter(
        "Calls until then", calls_left, "How often it is asked before [-].", dealii::Patterns::Integer(0));
    }

    double gamma(const alluvium::coupling::DragState &) const override
    {
      if (failing_rank >= 0 && calls_left-- == 0 &&
          static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) == failing_rank)
        throw std::runtime_error("This law has failed.");
      return resistance;
    }

  private:
    double       resistance   = 1e6;
    int          failing_rank = -1;
    mutable long calls_left   = 0;
  };

  ALLUVIUM_REGISTER_DRAG_LAW(LinearDrag, "linear", "A constant, for tests.")


  /** The pressure under a column of water whose height grows with time. */
  class RisingWater : public alluvium::fluid::BoundaryPlugin
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Rate", rate, "How fast the column grows, in heights of the domain [1/s].");
    }

    Gives gives() const override { return Gives::pressure; }

    void initialize(const std::map<std::string, double> &constants) override
    {
      at_start = constants.at("rho") * constants.at("g") * constants.at("H");
    }

    double value(const dealii::Point<2> &, const double time, const unsigned int) const override
    {
      return at_start * (1. + rate * time);
    }

  private:
    double rate = 0., at_start = 0.;
  };

  ALLUVIUM_REGISTER_BOUNDARY_CONDITION(RisingWater, "rising water", "Hydrostatic, and more and more.")


  /** Fluid that is drawn off evenly. */
  class Suction : public alluvium::fluid::BoundaryPlugin
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Velocity", velocity, "Upwards [m/s].");
    }

    Gives gives() const override { return Gives::velocity; }

    double value(const dealii::Point<2> &, const double, const unsigned int component) const override
    {
      return component == 1 ? velocity : 0.;
    }

  private:
    double velocity = 0.;
  };

  ALLUVIUM_REGISTER_BOUNDARY_CONDITION(Suction, "suction", "An even velocity.")
} // namespace
