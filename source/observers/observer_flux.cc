#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/flow_totals.h>
#include <alluvium/fluid/largest_speed.h>
#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace alluvium::observers
{
  namespace
  {
    class Flux : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override
      {
        return s.fluid && (!open_boundaries(s).empty() || is_periodic(s, 0) || is_periodic(s, 1));
      }

      void add_columns(const Snapshot &s, output::Statistics &statistics) override
      {
        std::vector<std::string> names;
        for (const auto &[id, name] : open_boundaries(s))
          names.push_back(name);
        in_columns = output::names_in_columns(names);
        for (const auto &name : names)
          statistics.add_column("flux_" + in_columns.at(name) + "_m2_per_s");
        if (!open_boundaries(s).empty())
          statistics.add_column("flux_imbalance");
        for (unsigned int d = 0; d < 2; ++d)
          if (is_periodic(s, d))
            statistics.add_column(along(d));
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.step == 0)
          return;
        double sum = 0., size = 0.;
        for (const auto &[id, name] : open_boundaries(s))
          {
            const double flux = s.fluid->solver.flux(id);
            last[name]        = flux;
            sum += flux;
            size = std::max(size, std::abs(flux));
            statistics.set("flux_" + in_columns.at(name) + "_m2_per_s", flux);
          }
        if (!open_boundaries(s).empty())
          {
            // where fluid flows along the boundaries only, or in and out through one alone, fluxes are what the linear
            // solver leaves, and so is what they differ by
            const double width   = std::max(s.right - s.left, s.top - s.bottom),
                         passing = width * fluid::largest_speed(s.fluid->space, s.fluid->solver.solution().block(0));
            // of a slower flow the digits of the velocity tell nothing
            constexpr double smallest_reynolds = 1e-20;
            const auto      &fluid             = s.fluid->solver.properties;
            const bool       flows             = fluid.density * passing > smallest_reynolds * fluid.viscosity;
            const bool       one_alone         = open_boundaries(s).size() == 1;
            statistics.set("flux_imbalance",
                           flows && size > s.fluid->solver.linear_solver.tolerance * passing
                             ? sum / (one_alone ? passing : size)
                             : 0.);
          }
        if (!is_periodic(s, 0) && !is_periodic(s, 1))
          return;
        const auto totals = coupling::flow_totals(
          s.fluid->coupling, s.fluid->space, s.fluid->solver, s.fluid->boundary_conditions, s.grains);
        for (unsigned int d = 0; d < 2; ++d)
          if (is_periodic(s, d))
            {
              double volume_flux = totals.momentum[d] / s.fluid->solver.properties.density; // [m^3/s]
              for (std::size_t i = 0; i < s.grains.n(); ++i)
                volume_flux += grains::disc_volume(s.grains.fluid_radius[i]) *
                               (d == 0 ? s.grains.velocity[0][i] : s.grains.velocity[1][i]);
              const double flux                    = volume_flux / s.fluid->space.periodic_box().length[d];
              last[d == 0 ? "along_x" : "along_y"] = flux;
              statistics.set(along(d), flux);
            }
      }

      void conclude(output::Summary &summary) const override
      {
        for (const auto &[name, flux] : last)
          summary.set("flux/" + name + "_m2_per_s", flux);
      }

      void save(nlohmann::ordered_json &state) const override { state = last; }
      void load(const nlohmann::ordered_json &state) override { last = state.get<decltype(last)>(); }

    private:
      static bool is_periodic(const Snapshot &s, const unsigned int d)
      {
        return s.fluid->space.periodic_box().length[d] > 0.;
      }

      static std::string along(const unsigned int d)
      {
        return d == 0 ? "flux_along_x_m2_per_s" : "flux_along_y_m2_per_s";
      }

      static std::map<dealii::types::boundary_id, std::string> open_boundaries(const Snapshot &s)
      {
        std::map<dealii::types::boundary_id, std::string> result;
        for (const auto &[id, condition] : s.fluid->boundary_conditions.all())
          if (condition.kind->lets_fluid_pass())
            result[id] = condition.name;
        return result;
      }

      std::map<std::string, std::string> in_columns; // of boundaries
      std::map<std::string, double>      last;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Flux,
    "flux",
    "Flux of the mixture out through every open boundary, and their sum over the largest; its mean "
    "over the sections of a periodic box.")
} // namespace alluvium::observers
