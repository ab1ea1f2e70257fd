#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::deposits
{
  /** Grains from a table that the user brings. */
  class DepositFromFile : public Deposit
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter(
        "File",
        file,
        "CSV file, relative to the parameter file. Its header names the columns: x, y, radius (required), "
        "density, vx, vy, omega (SI units).");
    }

    void parse_parameters() override { check_user(!file.empty(), "The deposit 'file' needs the parameter 'File'."); }

    std::vector<NewGrain> make(const DepositContext &context) const override
    {
      return read_grain_table(path_from(context.directory, file), context.density);
    }

  private:
    std::string file;
  };

  ALLUVIUM_REGISTER(Deposit, DepositFromFile, "file", "the grains of a CSV file.")
} // namespace alluvium::deposits
