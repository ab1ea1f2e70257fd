#pragma once

// A settled bed of free grains on the floor of a channel, with contacts.
#include "bed.h"

#include <alluvium/coupling/coupled_step.h>

namespace bed
{
  /** What a test of free grains may vary besides Settings. */
  struct FreeBedSettings
  {
    double       density = 2630., friction = 0.4, across = 20.; // [kg/m^3], and [d]
    unsigned int n                  = 240;
    double       residual_tolerance = 1e-6;  // of the contacts
    bool         is_strict          = false; // nothing but that tolerance ends a solve
  };

  class FreeBed
  {
  public:
    static constexpr double d = 2.2e-4, g = 9.81; // SI

    FreeBed(const Settings &s, const FreeBedSettings &f)
      : width(f.across * d)
      , channel(width, 24. * d, s.h_over_d * d, s, 0.)
      , coupled_step(channel.solver, channel.coupling, stepper, timers)
    {
      channel.solver.gravity[1] = -g;
      channel.solver.choose_datum(channel.bc);
      stepper.set_walls({{{{0., 0.}}, {{width, 0.}}, {}, "floor"},
                         {{{0., 0.}}, {{0., 1.}}, {}, "left"},
                         {{{width, 0.}}, {{width, 1.}}, {}, "right"}});
      stepper.settings().residual_tolerance = f.residual_tolerance;
      if (f.is_strict)
        {
          stepper.settings().stagnation_factor = 1.;
          stepper.settings().halve_stalled     = true;
        }
      stepper.settings().friction = f.friction;
      double area                 = 0.;
      for (const auto &seed : settled_seeds(1, f.n, width))
        {
          grains.resize(grains.n() + 1);
          const std::size_t k   = grains.n() - 1;
          grains.id[k]          = k;
          grains.position[0][k] = grains.initial_position[0][k] = seed.x;
          grains.position[1][k] = grains.initial_position[1][k] = seed.y;
          grains.radius[k]                                      = seed.radius;
          grains.fluid_radius[k]                                = 0.8 * seed.radius;
          grains.mass[k]                                        = f.density * numbers::PI * seed.radius * seed.radius;
          area += numbers::PI * seed.radius * seed.radius;
          onset += (f.density - 0.64 * 1000.) * numbers::PI * seed.radius * seed.radius * g / width;
        }
      touched.assign(grains.n(), 0);
    }

    /** Let the pressure below exceed hydrostatic by @p fraction of what lifts the bed. */
    void set_head(const double fraction) { channel.set_pressure_below(fraction * onset + 24. * d * 1000. * g); }

    void step(const bool fixed = false)
    {
      auto &c = channel;
      coupled_step.prepare();
      coupled_step.step(c.bc, {time, c.settings.dt, {{0., -g}}, fixed}, touched, grains, c.loads, report);
      time += c.settings.dt;
      if (!fixed)
        touched = stepper.touched();
    }

    double flux() const { return channel.solver.flux(3); }

    /** Mean |v* - v| over the grains [m/s]. */
    double prediction_error() const
    {
      double sum = 0.;
      for (std::size_t k = 0; k < grains.n(); ++k)
        {
          const auto &v = channel.coupling.predicted_velocity()[k];
          sum += std::hypot(v[0] - grains.velocity[0][k], v[1] - grains.velocity[1][k]);
        }
      return sum / grains.n();
    }

    double                             width, onset = 0., time = 0.; // [m], submerged weight over width [Pa], [s]
    Channel                            channel;
    alluvium::contacts::ContactStepper stepper;
    alluvium::Timers                   timers;
    coupling::CoupledStep              coupled_step;
    grains::GrainArrays                grains;
    std::vector<std::uint8_t>          touched;
    alluvium::contacts::ContactReport  report;
  };
} // namespace bed
