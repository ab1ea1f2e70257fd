#include <alluvium/deposits/deposit.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/parameter_handler.h>

namespace alluvium::deposits
{
  namespace
  {
    /** Fluid alone. */
    class NoGrains : public Deposit
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Unit of length",
                          unit,
                          "What stands for the grains' diameter where sizes are measured in it, such as those of cells "
                          "[m].",
                          dealii::Patterns::Double(1e-12));
      }

      std::vector<NewGrain> make(const DepositContext &) const override { return {}; }
      double                unit_length() const override { return unit; }

    private:
      double unit = 1e-3;
    };
  } // namespace

  ALLUVIUM_REGISTER(Deposit, NoGrains, "none", "no grains: the fluid flows alone.")
} // namespace alluvium::deposits
