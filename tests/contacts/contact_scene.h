// Grains under gravity between walls, step by step: what tests of contacts are made of.
#pragma once

#include <alluvium/contacts/contact_stepper.h>

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <cmath>
#include <string>

namespace alluvium::contacts::test
{
  using namespace grains;

  constexpr double g = 9.81, d = 1e-3, r = 0.5 * d, density = 2500.; // SI

  /** A few grains, walls and a stepper, under gravity and whatever drag a test sets. */
  struct Scene
  {
    GrainArrays    grains;
    GrainLoads     loads;
    ContactStepper stepper;
    double         gx = 0., gy = -g;
    ContactReport  report;

    /** Parameters of section "Contacts", as in a parameter file. */
    void set(const std::string &text)
    {
      dealii::ParameterHandler prm;
      stepper.add_parameters(prm);
      prm.parse_input_from_string(text);
      stepper.parse_parameters();
    }

    std::size_t add(const double x, const double y, const double vx = 0., const double vy = 0., const double radius = r)
    {
      const std::size_t k = grains.n();
      grains.resize(k + 1);
      grains.id[k]          = static_cast<GrainId>(10 * k + 3); // ids are not indices
      grains.position[0][k] = x;
      grains.position[1][k] = y;
      grains.radius[k]      = radius;
      grains.mass[k]        = density * M_PI * radius * radius;
      grains.velocity[0][k] = vx;
      grains.velocity[1][k] = vy;
      return k;
    }

    void floor(const std::array<double, 2> velocity = {{0., 0.}})
    {
      stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, velocity, "floor"}});
    }

    /** Turn gravity by @p angle, as if the floor were inclined and fell towards +x. */
    void incline(const double angle)
    {
      gx = g * std::sin(angle);
      gy = -g * std::cos(angle);
    }

    void step(const double dt, const int n = 1)
    {
      for (int s = 0; s < n; ++s)
        {
          if (loads.drag.size() != grains.n())
            loads.drag.assign(grains.n(), 0.);
          loads.force[0].resize(grains.n());
          loads.force[1].resize(grains.n());
          for (std::size_t k = 0; k < grains.n(); ++k)
            {
              loads.force[0][k] = grains.mass[k] * gx;
              loads.force[1][k] = grains.mass[k] * gy;
            }
          report = stepper.advance(grains, loads, dt, {{gx, gy}});
        }
    }

    double kinetic_energy() const
    {
      double e = 0.;
      for (std::size_t k = 0; k < grains.n(); ++k)
        e += 0.5 * grains.mass[k] *
             (grains.velocity[0][k] * grains.velocity[0][k] + grains.velocity[1][k] * grains.velocity[1][k] +
              0.5 * std::pow(grains.radius[k] * grains.omega[k], 2));
      return e;
    }

    double energy() const
    {
      double e = kinetic_energy();
      for (std::size_t k = 0; k < grains.n(); ++k)
        e -= grains.mass[k] * (gx * grains.position[0][k] + gy * grains.position[1][k]);
      return e;
    }

    double weight() const
    {
      double w = 0.;
      for (const double m : grains.mass)
        w += m * std::hypot(gx, gy);
      return w;
    }

    /** Tight enough for comparison with closed forms. */
    void exact()
    {
      stepper.settings().residual_tolerance = 1e-13;
      stepper.settings().stagnation_factor  = 1.;
      stepper.settings().dead_zone          = 0.;
      stepper.settings().rest_steps         = 0;
    }
  };
} // namespace alluvium::contacts::test
