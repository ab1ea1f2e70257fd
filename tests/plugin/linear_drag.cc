// The program with one drag law more, which only this file knows: what somebody does who brings a plug-in of their own.
#include <alluvium/application.h>
#include <alluvium/coupling/drag_law.h>

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
} // namespace

int main(int argc, char **argv)
{
  return alluvium::run_application(argc, argv);
}
