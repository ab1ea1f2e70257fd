#include <alluvium/contacts/contact_report.h>
#include <alluvium/coupling/coupling.h>
#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::observers
{
  namespace
  {
    /** The books: what should be zero, scaled by what it is made of. */
    class Audit : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.fluid || s.contacts || s.step == 0; }

      void add_columns(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.fluid)
          for (const auto *name : {"third_law_defect",
                                   "clipped_solid_volume_m2",
                                   "prediction_defect_mean_m_per_s",
                                   "prediction_defect_max_m_per_s",
                                   "momentum_not_received_over_force",
                                   "fluid_residual"})
            statistics.add_column(name);
        statistics.add_column("mean_penetration_over_d");
        statistics.add_column("contact_residual");
        statistics.add_column("contact_smooth_velocity_over_g_dt");
      }

      void observe(const Snapshot &s) override
      {
        if (s.step == 0 || !s.fluid)
          return;
        const auto &report = s.fluid->coupling.report();
        for (unsigned int d = 0; d < 2; ++d)
          momentum_defect[d] += s.dt * report.momentum_defect[d];
        defect_gross += s.dt * std::hypot(report.momentum_defect[0], report.momentum_defect[1]);
        received += s.dt * report.force_scale;
        const double density = s.fluid->solver.properties.density;
        for (std::size_t i = 0; i < s.grains.n(); ++i)
          if (!std::isinf(s.grains.mass[i]))
            weight += s.dt * std::hypot(s.gravity[0], s.gravity[1]) *
                      std::abs(s.grains.mass[i] - grains::disc_mass(density, s.grains.fluid_radius[i]));
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.step == 0)
          return;
        if (s.fluid)
          {
            s.fluid->coupling.audit();
            const auto &report = s.fluid->coupling.report();
            const auto &v_star = s.fluid->coupling.predicted_velocity();
            double      mean = 0., largest = 0., defect = 0.;
            for (std::size_t i = 0; i < std::min(s.grains.n(), v_star.size()); ++i)
              {
                const double d =
                  std::hypot(s.grains.velocity[0][i] - v_star[i][0], s.grains.velocity[1][i] - v_star[i][1]);
                mean += d / s.grains.n();
                largest = std::max(largest, d);
              }
            for (unsigned int d = 0; d < 2; ++d)
              defect = std::max(defect, std::abs(report.force_on_grains[d] + report.force_on_fluid[d]));
            // smaller forces are what the digits of their parts leave
            constexpr double smallest = 1e-6;
            const double     scale    = std::max(report.force_scale, smallest * report.force_parts);
            const auto       share    = [&](const double difference) { return scale > 0. ? difference / scale : 0.; };
            third_law                 = std::max(third_law, share(defect));
            statistics.set("third_law_defect", share(defect));
            statistics.set("clipped_solid_volume_m2", report.clipped_volume);
            statistics.set("prediction_defect_mean_m_per_s", mean);
            statistics.set("prediction_defect_max_m_per_s", largest);
            statistics.set("momentum_not_received_over_force",
                           share(std::hypot(report.momentum_defect[0], report.momentum_defect[1])));
            statistics.set("fluid_residual", s.fluid->solver.last_report().residual);
          }
        if (s.contacts)
          {
            const double d = s.grains.n() > 0 ? grains::mean_diameter(s.grains) : 1.;
            statistics.set("mean_penetration_over_d", s.contacts->mean_penetration / d);
            statistics.set("contact_residual", s.contacts->residual);
            statistics.set("contact_smooth_velocity_over_g_dt", s.contacts->smooth_velocity);
            penetration     = std::max(penetration, s.contacts->max_penetration / d);
            smooth_velocity = std::fmax(smooth_velocity, s.contacts->smooth_velocity); // which may be no number
          }
      }

      void conclude(output::Summary &summary) const override
      {
        summary.set("audit/largest_third_law_defect", third_law);
        summary.set("audit/largest_penetration_over_d", penetration);
        if (!std::isnan(smooth_velocity))
          summary.set("audit/largest_contact_smooth_velocity_over_g_dt", smooth_velocity);
        if (received > 0.)
          {
            // of the exchange, and of the weight: in still water the exchange is next to nothing
            constexpr double allowed = 1e-3, allowed_of_weight = 1e-5;
            const double     missing = std::hypot(momentum_defect[0], momentum_defect[1]),
                         exchanged = std::max(received, 1e-12 * weight), share = missing / exchanged;
            summary.set("audit/momentum_not_received_over_impulse", share);
            summary.set("audit/momentum_not_received_without_regard_to_sign", defect_gross / exchanged);
            if (share > allowed && missing > allowed_of_weight * weight)
              summary.warn(
                "More than 0.1 % of the momentum that fluid and grains exchanged did not reach the fluid (see "
                "audit/momentum_not_received_over_impulse): where grains begin to move, contact forces are "
                "not what the fluid was solved with. Smaller time steps make it less, and so does Coupling/Time "
                "scheme = iterated where it is not in use.");
          }
      }

      void save(nlohmann::ordered_json &state) const override
      {
        state = {
          third_law, penetration, momentum_defect[0], momentum_defect[1], defect_gross, received, weight, nullptr};
        if (!std::isnan(smooth_velocity))
          state.back() = smooth_velocity;
      }

      void load(const nlohmann::ordered_json &state) override
      {
        third_law   = state.at(0).get<double>();
        penetration = state.at(1).get<double>();
        for (unsigned int d = 0; d < 2; ++d)
          momentum_defect[d] = state.at(2 + d).get<double>();
        defect_gross = state.at(4).get<double>();
        received     = state.at(5).get<double>();
        weight       = state.size() > 6 ? state.at(6).get<double>() : 0.;
        if (state.size() > 7 && !state.at(7).is_null())
          smooth_velocity = state.at(7).get<double>();
      }

    private:
      double third_law = 0., penetration = 0., smooth_velocity = std::numeric_limits<double>::quiet_NaN();
      // momentum that grains got and the fluid did not, and sum of |force| dt over the grains [N s/m]
      std::array<double, 2> momentum_defect = {{0., 0.}};
      double                defect_gross = 0., received = 0.;
      double                weight = 0.; // of what can move, without buoyancy, times time [N s/m]
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Audit,
    "audit",
    "What should vanish: defect of the third law, clipped solid volume, prediction defect |v - v*|, drag "
    "momentum that the grains got and the fluid did not, residuals, penetration, the smooth velocity left in a bed at "
    "rest.")
} // namespace alluvium::observers
