#include <alluvium/fluid/energy_balance.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace alluvium::observers
{
  namespace
  {
    /** The fluid's energy balance, step by step and over the run. */
    class Energy : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.fluid != nullptr; }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        statistics.add_column("fluid_kinetic_energy_J_per_m");
        for (const char *name : names)
          statistics.add_column("power_" + std::string(name) + "_W_per_m");
      }

      void observe(const Snapshot &s) override
      {
        if (s.step == 0)
          return;
        const auto  &solver  = s.fluid->solver;
        const auto   balance = fluid::energy_balance(s.fluid->space, solver.problem(), solver.solution());
        const double rate    = (balance.kinetic_energy - (known ? kinetic_energy : balance.kinetic_before)) / s.dt;
        power                = {{balance.boundaries + balance.body,
                                 -balance.to_grains,
                                 -balance.drag,
                                 -balance.viscous,
                                 -balance.stabilisation,
                                 -balance.time,
                                 -balance.open,
                                 rate - balance.explained()}};
        kinetic_energy       = balance.kinetic_energy;
        known                = true;
        for (unsigned int i = 0; i < power.size(); ++i)
          {
            work[i] += s.dt * power[i];
            gross += s.dt * std::abs(power[i]) / 2.;
          }
        if (power.back() > 0.)
          from_nowhere += s.dt * power.back();
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.step == 0)
          return;
        statistics.set("fluid_kinetic_energy_J_per_m", kinetic_energy);
        for (unsigned int i = 0; i < power.size(); ++i)
          statistics.set("power_" + std::string(names[i]) + "_W_per_m", power[i]);
      }

      void conclude(output::Summary &summary) const override
      {
        for (unsigned int i = 0; i < work.size(); ++i)
          summary.set("energy/" + std::string(names[i]) + "_J_per_m", work[i]);
        if (gross > 0.)
          summary.set("energy/unexplained_gain_over_exchanged", from_nowhere / gross);
        constexpr double allowed = 0.5;
        if (from_nowhere > allowed * gross)
          summary.warn("More than half of the energy that the fluid exchanged is not explained by its balance (see "
                       "energy/unexplained_gain_over_exchanged): cells are too coarse for the grains or the flow in "
                       "them, or stabilisation is as large as what drives the flow. Try a smaller cell size.");
      }

      void save(nlohmann::ordered_json &state) const override
      {
        state = {{"kinetic energy", kinetic_energy},
                 {"known", known},
                 {"power", power},
                 {"work", work},
                 {"gross", gross},
                 {"from nowhere", from_nowhere}};
      }

      void load(const nlohmann::ordered_json &state) override
      {
        kinetic_energy = state.at("kinetic energy").get<double>();
        known          = state.at("known").get<bool>();
        power          = state.at("power").get<decltype(power)>();
        work           = state.at("work").get<decltype(work)>();
        gross          = state.at("gross").get<double>();
        from_nowhere   = state.at("from nowhere").get<double>();
      }

    private:
      static constexpr unsigned int                n     = 8;
      static constexpr std::array<const char *, n> names = {
        {"boundaries", "grains", "drag", "viscosity", "stabilisation", "time_steps", "open_boundaries", "unexplained"}};
      std::array<double, n> power{}, work{}; // given to the fluid's kinetic energy [W/m], [J/m]
      double                kinetic_energy = 0., gross = 0., from_nowhere = 0.;
      bool                  known = false;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Energy,
    "energy",
    "The fluid's energy balance: kinetic energy, and the powers that boundaries, grains, drag, "
    "viscosity, stabilisation, time steps and terms of boundaries (open ones, walls with a slip length) give it, and "
    "what is left "
    "unexplained. Costs about an assembly a step.")
} // namespace alluvium::observers
