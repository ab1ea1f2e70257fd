#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/observers/observer.h>
#include <alluvium/utilities/digits.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>
#include <limits>

namespace alluvium::observers
{
  namespace
  {
    /**
     * Hindered settling, to be compared with the drag law. In a homogeneous suspension without net flux the pressure
     * gradient carries the mixture, so that gamma w = eps (rho_p - rho) g for the slip w, and grains sink with eps w:
     * the superficial velocity that would fluidise them.
     */
    class Settling : public Observer
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Bottom", bottom, "Only grains with their centre above are looked at [m]. By default all.");
        prm.add_parameter("Top", top, "Only grains with their centre below are looked at [m]. By default all.");
      }

      bool applies(const Snapshot &s) const override
      {
        check_user(bottom < s.top && top > s.bottom,
                   "Output/Observers: settling: from 'Bottom' = " + in_digits(bottom) +
                     " m to 'Top' = " + in_digits(top) + " m there is nothing of the domain, which reaches from " +
                     in_digits(s.bottom) + " to " + in_digits(s.top) + " m.");
        check_user(top > bottom,
                   "Output/Observers: settling: 'Bottom' and 'Top' must be the ends of a range of heights [m]: " +
                     in_digits(bottom) + " and " + in_digits(top) + " are not.");
        return s.fluid && std::hypot(s.gravity[0], s.gravity[1]) > 0.;
      }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        for (const auto *name : {"settling_speed_m_per_s",
                                 "settling_speed_over_drag_law",
                                 "settling_speed_rms_m_per_s",
                                 "sideways_speed_rms_m_per_s",
                                 "settling_packing_fraction",
                                 "settling_force_over_weight"})
          statistics.add_column(name);
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        const auto         &g    = s.grains;
        const double        size = std::hypot(s.gravity[0], s.gravity[1]);
        grains::GrainArrays inside;
        double              volume = 0., mean = 0., square = 0., sideways = 0., up = 0., weight = 0.;
        const auto         &force   = s.fluid->coupling.fluid_force(); // none yet at t = 0
        const double        density = s.fluid->solver.properties.density;
        for (std::size_t i = 0; i < g.n(); ++i)
          if (g.position[1][i] > bottom && g.position[1][i] < top)
            {
              const double down   = (g.velocity[0][i] * s.gravity[0] + g.velocity[1][i] * s.gravity[1]) / size,
                           across = (g.velocity[0][i] * s.gravity[1] - g.velocity[1][i] * s.gravity[0]) / size,
                           v      = grains::disc_volume(g.fluid_radius[i]);
              inside.resize(inside.n() + 1);
              inside.fluid_radius.back() = g.fluid_radius[i];
              inside.mass.back()         = g.mass[i];
              volume += v;
              mean += v * down;
              square += v * down * down;
              sideways += v * across * across;
              weight += (g.mass[i] - density * v) * size;
              if (i < force.size())
                up -= (force[i][0] * s.gravity[0] + force[i][1] * s.gravity[1]) / size;
            }
        if (inside.n() == 0)
          return;
        mean /= volume;
        const double height  = std::min(top, s.top) - std::max(bottom, s.bottom);
        const double packing = volume / ((s.right - s.left) * height);
        const double law =
          coupling::HomogeneousBed{inside, s.fluid->solver.properties, 1. - packing}.fluidisation_velocity(
            s.fluid->coupling.drag_law(), size);
        statistics.set("settling_speed_m_per_s", mean);
        statistics.set("settling_speed_over_drag_law",
                       law > 0. ? mean / law : std::numeric_limits<double>::quiet_NaN());
        statistics.set("settling_speed_rms_m_per_s", std::sqrt(std::max(0., square / volume - mean * mean)));
        statistics.set("sideways_speed_rms_m_per_s", std::sqrt(sideways / volume));
        statistics.set("settling_packing_fraction", packing);
        statistics.set("settling_force_over_weight",
                       weight > 0. ? up / weight : std::numeric_limits<double>::quiet_NaN());
      }

    private:
      double bottom = -1e9, top = 1e9;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    Settling,
    "settling",
    "Mean speed at which the grains of a range of heights sink, its fluctuations, the fluid's "
    "force on them, and what the drag law makes of it in a homogeneous suspension without net flux.")
} // namespace alluvium::observers
