#include <alluvium/contacts/contact_report.h>
#include <alluvium/coupling/coupling.h>
#include <alluvium/grains/wall.h>
#include <alluvium/observers/lasting_event.h>
#include <alluvium/observers/observer.h>

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::observers
{
  namespace
  {
    /**
     * Who carries the grains: floor, walls, fluid. Where the flow crosses a bed that reaches from side to side, it is
     * fluidised by force balance at the head at which the fluid carries the whole submerged weight, (s phi_m - phi_b) L
     * whatever the mesh and the drag law (L the height of the bed, phi_m the packing that has mass, phi_b the packing
     * that the fluid sees). Elsewhere there is no such onset. It counts if the fluid carries at least 0.98 of the
     * weight in the mean over sqrt(d/g) from then on, and the floor less than a tenth.
     */
    class Support : public Observer
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Floor",
                          floor,
                          "Name of the wall that is the floor. Where the default is not among the walls, there is no "
                          "floor, and what needs one is left out.");
      }

      bool applies(const Snapshot &s) const override
      {
        std::string known;
        for (const auto &wall : s.walls)
          if (known.find("'" + wall.name + "'") == std::string::npos)
            known += (known.empty() ? "'" : ", '") + wall.name + "'";
        check_user(floor == default_floor || has_floor(s),
                   "Output/Observers: support/Floor: there is no wall '" + floor + "'. The walls are " +
                     (known.empty() ? "none" : known) + ".");
        return std::hypot(s.gravity[0], s.gravity[1]) > 0.;
      }

      void add_columns(const Snapshot &s, output::Statistics &statistics) override
      {
        if (has_floor(s))
          statistics.add_column("floor_force_over_weight");
        statistics.add_column("wall_force_over_weight");
        if (s.fluid)
          statistics.add_column("fluid_force_over_weight");
      }

      void observe(const Snapshot &s) override
      {
        const auto  &g      = s.grains;
        const double g_norm = std::hypot(s.gravity[0], s.gravity[1]);
        const double rho    = s.fluid ? s.fluid->solver.properties.density : 0.;
        double       weight = 0., area_fluid = 0., mass = 0.;
        for (std::size_t i = 0; i < g.n(); ++i)
          {
            const double area = grains::disc_volume(g.fluid_radius[i]);
            mass += g.mass[i];
            area_fluid += area;
            weight += (g.mass[i] - rho * area) * g_norm;
          }
        if (weight == 0.) // no grains, or as heavy as the fluid
          weight = std::numeric_limits<double>::infinity();
        if (s.contacts)
          {
            knows_floor = has_floor(s);
            floor_share = wall_share = 0.;
            for (const auto &[name, force] : s.contacts->wall_force)
              {
                const double share = (force[0] * s.gravity[0] + force[1] * s.gravity[1]) / (g_norm * weight);
                wall_share += share;
                if (name == floor)
                  floor_share += share;
              }
          }
        if (s.fluid)
          {
            if (s.step == 0 && s.fluid->head_of_bed && s.fluid->crosses_bed)
              exact = (mass / rho - area_fluid) / (s.right - s.left);
            const auto  &report = s.fluid->coupling.report();
            const double now =
              s.step == 0 ? 0.
                          : -(report.force_on_grains[0] * s.gravity[0] + report.force_on_grains[1] * s.gravity[1]) /
                              (g_norm * weight);
            const double hold = std::sqrt(grains::mean_diameter(g) / g_norm);
            if (std::isfinite(exact) && onset.is_awaited() && now >= 1. && s.step > 0)
              {
                double part = now > fluid_share ? (1. - fluid_share) / (now - fluid_share) : 1.;
                part        = std::max(0., part);
                onset.begin(last_head + part * (s.fluid->head - last_head), s.time - (1. - part) * s.dt);
              }
            // the floor lets go: its force, nearly linear in the head, extrapolated to zero from 2 % of the weight
            if (std::isfinite(exact) && knows_floor && floor_free.is_awaited() && s.contacts && s.step > 1 &&
                floor_share < 0.02 && last_floor > floor_share)
              floor_free.begin(s.fluid->head + floor_share * (s.fluid->head - last_head) / (last_floor - floor_share),
                               s.time);
            onset.follow(now, s.dt, 0.98, hold);
            floor_free.follow(1. - floor_share, s.dt, 0.9, hold);
            fluid_share = now;
            last_head   = s.fluid->head;
          }
        last_floor = floor_share;
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.contacts)
          {
            if (has_floor(s))
              statistics.set("floor_force_over_weight", floor_share);
            statistics.set("wall_force_over_weight", wall_share);
          }
        if (s.fluid)
          statistics.set("fluid_force_over_weight", fluid_share);
      }

      void conclude(output::Summary &summary) const override
      {
        if (knows_floor)
          summary.set("support/final_floor_force_over_weight", floor_share);
        summary.set("support/final_wall_force_over_weight", wall_share);
        if (std::isfinite(exact))
          summary.set("onset by force balance/exact_head_m", exact);
        if (onset.has_happened())
          {
            summary.set("onset by force balance/differential_head_m", onset.head());
            summary.set("onset by force balance/time_s", onset.time());
            summary.set("onset by force balance/over_exact", onset.head() / exact);
          }
        if (floor_free.has_happened())
          summary.set("onset by force balance/floor_free_differential_head_m", floor_free.head());
      }

      void save(nlohmann::ordered_json &state) const override
      {
        state = {{"numbers", {exact, fluid_share, last_head, last_floor, floor_share, wall_share}},
                 {"onset", onset.state()},
                 {"floor free", floor_free.state()}};
      }

      void load(const nlohmann::ordered_json &state) override
      {
        unsigned int i = 0;
        for (double *value : {&exact, &fluid_share, &last_head, &last_floor, &floor_share, &wall_share})
          {
            const auto &number = state.at("numbers").at(i++);
            *value             = number.is_null() ? nan : number.get<double>();
          }
        onset.set_state(state.at("onset").get<std::array<double, 7>>());
        floor_free.set_state(state.at("floor free").get<std::array<double, 7>>());
      }

    private:
      static constexpr double      nan           = std::numeric_limits<double>::quiet_NaN();
      static constexpr const char *default_floor = "bottom";

      bool has_floor(const Snapshot &s) const
      {
        return std::any_of(s.walls.begin(), s.walls.end(), [&](const auto &wall) { return wall.name == floor; });
      }

      std::string floor       = default_floor;
      bool        knows_floor = true;
      double      floor_share = 0., wall_share = 0., fluid_share = 0., last_head = 0., last_floor = 1.;
      double      exact = nan;

      LastingEvent onset, floor_free;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Support,
    "support",
    "Forces on the floor, on all walls and of the fluid over the grains' submerged weight; the onset of "
    "fluidisation by force balance beside its exact value.")
} // namespace alluvium::observers
