#include <alluvium/coupling/coupling.h>
#include <alluvium/fluid/largest_speed.h>
#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::observers
{
  namespace
  {
    class Bed : public Observer
    {
    public:
      void add_columns(const Snapshot &s, output::Statistics &statistics) override
      {
        if (has_height(s))
          statistics.add_column("bed_height_m");
        statistics.add_column("largest_grain_velocity_m_per_s");
        statistics.add_column("kinetic_energy_J_per_m");
        if (s.fluid)
          {
            statistics.add_column("largest_fluid_velocity_m_per_s");
            statistics.add_column("smallest_void_fraction");
            statistics.add_column("largest_void_fraction");
          }
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        const auto &g       = s.grains;
        double      fastest = 0., energy = 0.;
        for (std::size_t i = 0; i < g.n(); ++i)
          {
            const double v2 = g.velocity[0][i] * g.velocity[0][i] + g.velocity[1][i] * g.velocity[1][i];
            fastest         = std::max(fastest, std::sqrt(v2));
            energy += 0.5 * (g.mass[i] * v2 + grains::disc_inertia(g.mass[i], g.radius[i]) * g.omega[i] * g.omega[i]);
          }
        if (has_height(s))
          {
            const auto faces = grains::find_bed_faces(g, s.left, s.right, geometry::Upright::of(s.gravity));
            height           = faces.empty() ? std::numeric_limits<double>::quiet_NaN() : faces.mean_height();
            statistics.set("bed_height_m", height);
          }
        statistics.set("largest_grain_velocity_m_per_s", fastest);
        statistics.set("kinetic_energy_J_per_m", energy);
        if (s.fluid)
          {
            statistics.set("largest_fluid_velocity_m_per_s",
                           fluid::largest_speed(s.fluid->space, s.fluid->solver.solution().block(0)));
            statistics.set("smallest_void_fraction", s.fluid->coupling.report().eps_min);
            statistics.set("largest_void_fraction", s.fluid->coupling.report().eps_max);
          }
      }

      void conclude(output::Summary &summary) const override { summary.set("bed/final_height_m", height); }

      void save(nlohmann::ordered_json &state) const override { state = height; }
      void load(const nlohmann::ordered_json &state) override
      {
        height = state.is_null() ? std::numeric_limits<double>::quiet_NaN() : state.get<double>();
      }

    private:
      /** Without gravity nothing is high. */
      static bool has_height(const Snapshot &s) { return s.gravity[0] != 0. || s.gravity[1] != 0.; }

      double height = std::numeric_limits<double>::quiet_NaN();
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Bed, "bed", "Height of the bed, fastest grain, kinetic energy, fastest fluid, range of the void fraction.")
} // namespace alluvium::observers
