// A homogeneous suspension whose grains and fluid move against each other without net flux: the slip decays with the
// rate
//   lambda = gamma / (eps (phi rho + eps rho_p) + C_m rho).
// Schemes converge with first order; those that freeze the grains in the continuity equation are stable only below dt =
// 2 eps^2 (1-r) tau_p.
#include "bed.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace
{
  using namespace dealii;
  constexpr double gamma_value = 5e6, rho = 1000., rho_p = 2630., v_start = 1e-3;

  class ConstantDrag : public alluvium::coupling::DragLaw
  {
  public:
    double gamma(const alluvium::coupling::DragState &) const override { return gamma_value; }
  };
  ALLUVIUM_REGISTER_DRAG_LAW(ConstantDrag, "constant (test)", "The same everywhere.")

  /** No net flux of the mixture and no viscous traction: the ends of a homogeneous suspension. */
  class Natural : public alluvium::fluid::BoundaryKind<2>
  {
  public:
    Velocity    velocity() const override { return Velocity::free; }
    std::string in_words() const override { return "natural"; }
  };

  /** 4 x 4 discs in each of 3 x 6 cells: every cell alike, so that all fields are uniform. */
  class Suspension
  {
  public:
    Suspension(const double eps, const std::string &scheme, const double dt, const double added_mass = 0.)
      : channel(3. * h, 6. * h, h, settings(scheme, dt, added_mass), 0.)
      , eps(eps)
    {
      channel.bc.set(2, {std::make_shared<Natural>(), "bottom", nullptr});
      channel.initialize();
      auto &g = channel_grains;
      g.resize(12 * 24);
      const double spacing = h / 4.;
      for (unsigned int j = 0; j < 24; ++j)
        for (unsigned int i = 0; i < 12; ++i)
          {
            const unsigned int k = j * 12 + i;
            g.id[k]              = k;
            g.position[0][k]     = (i + 0.5) * spacing;
            g.position[1][k]     = (j + 0.5) * spacing;
            g.radius[k] = g.fluid_radius[k] = std::sqrt((1. - eps) / numbers::PI) * spacing;
            g.mass[k]                       = rho_p * (1. - eps) * spacing * spacing;
            g.velocity[1][k]                = v_start;
          }
      // the fluid flows the other way, without net flux
      auto field = channel.space.make_field();
      for (const auto &cell : channel.space.cells())
        for (unsigned int v = 0; v < 4; ++v)
          field.block(0).local_element(cell.velocity[v][1]) = -(1. - eps) / eps * v_start;
      channel.solver.set_solution(field);
    }

    /** Velocity of the grains over the initial one after @p n steps; stops early where it has blown up. */
    double advance(const unsigned int n)
    {
      auto &g = channel_grains;
      for (unsigned int step = 0; step < n && std::abs(g.velocity[1][0]) < 1e3 * v_start; ++step)
        {
          channel.step(g, false);
          const double dt = channel.settings.dt;
          for (std::size_t k = 0; k < g.n(); ++k)
            {
              const double inertia = g.mass[k] + channel.loads.mass_added_to(k);
              const double m       = inertia + dt * channel.loads.drag[k];
              g.velocity[0][k]     = (inertia * g.velocity[0][k] + dt * channel.loads.force[0][k]) / m;
              g.velocity[1][k]     = (inertia * g.velocity[1][k] + dt * channel.loads.force[1][k]) / m;
            }
        }
      return g.velocity[1][g.n() / 2] / v_start;
    }

    static double rate(const double eps, const double added_mass = 0.)
    {
      return gamma_value / (eps * ((1. - eps) * rho + eps * rho_p) + added_mass * rho);
    }

  private:
    static bed::Settings settings(const std::string &scheme, const double dt, const double added_mass)
    {
      bed::Settings s;
      s.dt         = dt;
      s.filter     = 0.;
      s.drag       = "constant (test)";
      s.scheme     = scheme;
      s.added_mass = added_mass;
      return s;
    }

    static constexpr double  h = 1e-3;
    bed::Channel             channel;
    const double             eps;
    bed::grains::GrainArrays channel_grains;
  };
} // namespace

TEST(SlipRelaxation, FirstOrderConvergence)
{
  for (const double eps : {0.6, 0.8})
    for (const std::string scheme : {"explicit", "implicit drag", "semi-implicit per piece", "semi-implicit per grain"})
      {
        const double time = 1. / Suspension::rate(eps), exact = std::exp(-1.);
        double       error[3];
        for (unsigned int k = 0; k < 3; ++k)
          {
            const unsigned int n = 16 << k;
            error[k]             = std::abs(Suspension(eps, scheme, time / n).advance(n) - exact);
          }
        std::printf("eps %.1f %-24s errors %.2e %.2e %.2e orders %.2f %.2f\n",
                    eps,
                    scheme.c_str(),
                    error[0],
                    error[1],
                    error[2],
                    std::log2(error[0] / error[1]),
                    std::log2(error[1] / error[2]));
        EXPECT_LT(error[2], 0.05) << scheme;
        EXPECT_NEAR(std::log2(error[1] / error[2]), 1., 0.2) << scheme << " eps " << eps;
      }
}

TEST(SlipRelaxation, WithAddedMass)
{
  const double eps = 0.6;
  for (const std::string scheme : {"semi-implicit per piece", "semi-implicit per grain"})
    {
      const double time = 1. / Suspension::rate(eps, 1.), exact = std::exp(-1.);
      double       error[3];
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int n = 16 << k;
          error[k]             = std::abs(Suspension(eps, scheme, time / n, 1.).advance(n) - exact);
        }
      EXPECT_LT(error[2], 0.01) << scheme;
      EXPECT_GT(std::log2(error[1] / error[2]), 0.8) << scheme; // errors of the rate and of the phase may cancel
      EXPECT_LT(std::abs(Suspension(eps, scheme, 100. * time, 1.).advance(60)), 1.) << scheme;
    }
}

TEST(SlipRelaxation, FrozenGrainsAreUnstableAboveTheLimit)
{
  for (const double eps : {0.6, 0.48, 0.4})
    {
      const double tau = rho_p / gamma_value, r = (1. - eps) / (eps * rho_p / rho),
                   limit = 2. * eps * eps * (1. - r) * tau;
      EXPECT_LT(std::abs(Suspension(eps, "implicit drag", 0.75 * limit).advance(100)), 1.) << "eps " << eps;
      EXPECT_GT(std::abs(Suspension(eps, "implicit drag", 1.25 * limit).advance(100)), 10.) << "eps " << eps;
    }
}

TEST(SlipRelaxation, SemiImplicitHoldsAtHundredTimesTheLimit)
{
  for (const double eps : {0.6, 0.48, 0.4, 0.25}) // the last where freezing is unstable at any dt
    {
      const double tau = rho_p / gamma_value, r = (1. - eps) / (eps * rho_p / rho);
      const double limit = 2. * eps * eps * std::max(1. - r, 0.1) * tau;
      for (const std::string scheme : {"semi-implicit per piece", "semi-implicit per grain"})
        for (const double factor : {2., 100.})
          EXPECT_LT(std::abs(Suspension(eps, scheme, factor * limit).advance(60)), 1.)
            << scheme << " eps " << eps << " x " << factor;
    }
}
