#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace alluvium::observers
{
  namespace
  {
    /** What the latest change of the mesh did to solid volume, momentum and mass residual: in the first row after it.
     */
    class MeshChanges : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.fluid; }

      bool watches_mesh_changes() const override { return true; }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        for (const auto *name : {"mesh_change_cells_before", "mesh_change_cells", "mesh_change_share"})
          statistics.add_column(name);
        for (const auto *stage : stages)
          for (const auto *quantity :
               {"solid_volume_m2", "momentum_x_kg_per_s", "momentum_y_kg_per_s", "mass_residual"})
            statistics.add_column("mesh_change_" + std::string(quantity) + "_" + stage);
      }

      void observe(const Snapshot &s) override
      {
        if (!s.mesh_change || s.mesh_change->time == last_time)
          return;
        change    = *s.mesh_change;
        last_time = change.time;
        is_new    = true;
        ++n_changes;
        if (change.before.solid_volume > 0.)
          solid_volume = std::max(solid_volume, std::abs(change.after.solid_volume / change.before.solid_volume - 1.));
        mass_residual = std::max(mass_residual, change.after.mass_residual);
      }

      void write(const Snapshot &, output::Statistics &statistics) override
      {
        if (!is_new)
          return;
        is_new = false;
        statistics.set("mesh_change_cells_before", double(change.n_cells_before));
        statistics.set("mesh_change_cells", double(change.n_cells));
        statistics.set("mesh_change_share", change.share);
        const coupling::FlowTotals *const totals[] = {&change.before, &change.interpolated, &change.after};
        for (unsigned int i = 0; i < 3; ++i)
          {
            const auto set = [&](const std::string &quantity, const double value) {
              statistics.set("mesh_change_" + quantity + "_" + stages[i], value);
            };
            set("solid_volume_m2", totals[i]->solid_volume);
            set("momentum_x_kg_per_s", totals[i]->momentum[0]);
            set("momentum_y_kg_per_s", totals[i]->momentum[1]);
            set("mass_residual", totals[i]->mass_residual);
          }
      }

      void conclude(output::Summary &summary) const override
      {
        summary.set("mesh changes/number", n_changes);
        summary.set("mesh changes/largest_change_of_solid_volume", solid_volume);
        summary.set("mesh changes/largest_mass_residual_after", mass_residual);
      }

      void save(nlohmann::ordered_json &state) const override
      {
        state = {n_changes,
                 last_time,
                 solid_volume,
                 mass_residual,
                 is_new,
                 change.n_cells_before,
                 change.n_cells,
                 change.share};
        for (const auto *totals : {&change.before, &change.interpolated, &change.after})
          state.push_back({totals->solid_volume, totals->momentum[0], totals->momentum[1], totals->mass_residual});
      }

      void load(const nlohmann::ordered_json &state) override
      {
        n_changes     = state.at(0).get<unsigned int>();
        last_time     = state.at(1).get<double>();
        solid_volume  = state.at(2).get<double>();
        mass_residual = state.at(3).get<double>();

        is_new                = state.at(4).get<bool>();
        change.n_cells_before = state.at(5).get<decltype(change.n_cells_before)>();
        change.n_cells        = state.at(6).get<decltype(change.n_cells)>();
        change.share          = state.at(7).get<double>();
        unsigned int i        = 8;
        for (auto *totals : {&change.before, &change.interpolated, &change.after})
          {
            const auto &of        = state.at(i++);
            *totals               = {};
            totals->solid_volume  = of.at(0).get<double>();
            totals->momentum[0]   = of.at(1).get<double>();
            totals->momentum[1]   = of.at(2).get<double>();
            totals->mass_residual = of.at(3).get<double>();
          }
      }

    private:
      static constexpr std::array<const char *, 3> stages = {{"before", "interpolated", "after"}};

      unsigned int n_changes = 0;
      MeshChange   change;            // the latest
      bool         is_new    = false; // no row has told of it yet
      double       last_time = -1., solid_volume = 0., mass_residual = 0.;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    MeshChanges,
    "mesh changes",
    "Solid volume, momentum and mass residual of the flow before each change of the mesh, as interpolated and as the "
    "run goes on from it.")
} // namespace alluvium::observers
