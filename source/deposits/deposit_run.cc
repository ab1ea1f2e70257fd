#include <alluvium/contacts/grain_checkpoint.h>
#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

namespace alluvium::deposits
{
  namespace
  {
    /** Whether mass followed the fluid radius in the run whose checkpoint is @p folder. */
    bool mass_followed_fluid_radius(const std::string &folder)
    {
      const auto state =
        nlohmann::ordered_json::parse(read_checked_file(MPI_COMM_SELF, folder + "/state", "state"), nullptr, false);
      check_user(state.is_object() && state.contains("parameters"),
                 "'" + folder + "/state' is not as this program writes it: was it made by another version?");
      return state.at("parameters").value("Grains/Mass follows", "contact radius") == "fluid radius";
    }
  } // namespace

  /**
   * The grains as another run has left them: dry settling first, water then. What makes the scene (domain, walls, fluid
   * radius, boundary conditions) is this run's; time starts at 0, and contact forces are found anew.
   */
  class DepositFromRun : public Deposit
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Output folder",
                        output_folder,
                        "Output folder of the other run, relative to the parameter file. Its checkpoint is read, which "
                        "every run leaves at its end: places, radii, densities and velocities.");
      prm.add_parameter("Keep velocities", keep_velocities, "Whether grains start with the velocities they had then.");
    }

    void parse_parameters() override
    {
      check_user(!output_folder.empty(), "The deposit 'end of a run' needs the parameter 'Output folder'.");
    }

    std::vector<NewGrain> make(const DepositContext &context) const override
    {
      namespace fs         = std::filesystem;
      const std::string in = path_from(context.directory, output_folder);
      check_user(fs::is_directory(in), "Grains/Deposit: end of a run: there is no folder '" + in + "'.");
      std::string folder = in + "/checkpoint";
      if (!fs::exists(folder) && fs::exists(folder + ".before"))
        folder += ".before";
      check_user(fs::is_directory(folder),
                 "Grains/Deposit: end of a run: there is no checkpoint in '" + in +
                   "': the run has not ended, or it is no run's output folder.");
      grains::GrainArrays      grains;
      contacts::ContactArchive contacts;
      load_grains(MPI_COMM_SELF, folder + "/grains", grains, contacts);
      note_input(folder);
      const bool            fluid_radius = mass_followed_fluid_radius(folder);
      std::vector<NewGrain> new_grains;
      for (std::size_t i = 0; i < grains.n(); ++i)
        {
          const double r = fluid_radius ? grains.fluid_radius[i] : grains.radius[i];
          new_grains.push_back(
            {grains.position[0][i], grains.position[1][i], grains.radius[i], grains.mass[i] / grains::disc_volume(r)});
          if (keep_velocities)
            {
              new_grains.back().vx    = grains.velocity[0][i];
              new_grains.back().vy    = grains.velocity[1][i];
              new_grains.back().omega = grains.omega[i];
            }
        }
      return new_grains;
    }

  private:
    std::string output_folder;
    bool        keep_velocities = true;
  };

  ALLUVIUM_REGISTER(Deposit,
                    DepositFromRun,
                    "end of a run",
                    "the grains as another run has left them, dry settling before water for example.")
} // namespace alluvium::deposits
