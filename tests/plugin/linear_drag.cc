// The program with one drag law more, which only this file knows: what somebody does who brings a plug-in of their own.
#include <alluvium/application.h>
#include <alluvium/coupling/drag_law.h>

#include <deal.II/base/parameter_handler.h>

namespace
{
  class LinearDrag : public alluvium::coupling::DragLaw
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Resistance", resistance, "The same drag everywhere [N s/m^4].", dealii::Patterns::Double(0.));
    }

    double gamma(const alluvium::coupling::DragState &) const override { return resistance; }

  private:
    double resistance = 1e6;
  };

  ALLUVIUM_REGISTER_DRAG_LAW(LinearDrag, "linear", "A constant, for tests.")
} // namespace

int main(int argc, char **argv)
{
  return alluvium::run_application(argc, argv);
}
