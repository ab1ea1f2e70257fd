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
    /** An instant found by its threshold: time and head, linear between the two steps around it. */
    struct Event
    {
      double time = std::numeric_limits<double>::quiet_NaN(), head = time;
      bool   happened() const { return std::isfinite(time); }
    };

    class Motion : public Observer
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Distance",
          distance,
          "A grain is in motion once it is further than this from where it was at t = 0, in units of the largest "
          "grain diameter.",
          dealii::Patterns::Double(0.));
        prm.add_parameter("First movement",
                          first_fraction,
                          "Mass fraction in motion that makes the first movement.",
                          dealii::Patterns::Double(0., 1.));
        prm.add_parameter("Total heave",
                          heave_fraction,
                          "Mass fraction in motion that makes the total heave.",
                          dealii::Patterns::Double(0., 1.));
      }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        statistics.add_column("moved_mass_fraction");
      }

      void observe(const Snapshot &s) override
      {
        const auto &g = s.grains;
        for (const double r : g.radius)
          largest = std::max(largest, 2. * r);
        const double threshold = distance * largest;
        double       moving = s.leavers.total().mass, mass = moving;
        for (std::size_t i = 0; i < g.n(); ++i)
          {
            mass += g.mass[i];
            if (std::hypot(g.position[0][i] - g.initial_position[0][i], g.position[1][i] - g.initial_position[1][i]) >
                threshold)
              moving += g.mass[i];
          }
        const double now  = mass > 0. ? moving / mass : 0.;
        const double head = s.fluid ? s.fluid->head : std::numeric_limits<double>::quiet_NaN();
        const auto   mark = [&](Event &event, const double level) {
          if (!event.happened() && now >= level && s.step > 0)
            {
              const double part = now > fraction ? (level - fraction) / (now - fraction) : 1.;
              event.time        = s.time - (1. - part) * s.dt;
              event.head        = last_head + part * (head - last_head);
            }
        };
        mark(first, first_fraction);
        mark(heave, heave_fraction);
        fraction  = now;
        last_head = head;
      }

      void write(const Snapshot &, output::Statistics &statistics) override
      {
        statistics.set("moved_mass_fraction", fraction);
      }

      void conclude(output::Summary &summary) const override
      {
        for (const auto &[name, event] :
             {std::make_pair("first movement", first), std::make_pair("total heave", heave)})
          {
            summary.set(std::string(name) + "/happened", event.happened());
            if (event.happened())
              {
                summary.set(std::string(name) + "/time_s", event.time);
                if (std::isfinite(event.head))
                  summary.set(std::string(name) + "/differential_head_m", event.head);
              }
          }
        summary.set("motion/final_moved_mass_fraction", fraction);
      }

      void save(nlohmann::ordered_json &state) const override
      {
        state = {{"first", {first.time, first.head}},
                 {"heave", {heave.time, heave.head}},
                 {"last", {fraction, last_head, largest}}};
      }

      void load(const nlohmann::ordered_json &state) override
      {
        const auto number = [](const nlohmann::ordered_json &value) {
          return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
        };
        first     = {number(state.at("first")[0]), number(state.at("first")[1])};
        heave     = {number(state.at("heave")[0]), number(state.at("heave")[1])};
        fraction  = number(state.at("last")[0]);
        last_head = number(state.at("last")[1]);
        largest   = number(state.at("last")[2]);
      }

    private:
      double distance = 1., first_fraction = 0.05, heave_fraction = 0.95;
      double fraction = 0., last_head = 0.;
      double largest = 0.; // diameter [m]
      Event  first, heave;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Motion, "motion", "Mass fraction of the grains that have moved; the instants of first movement and total heave.")
} // namespace alluvium::observers
