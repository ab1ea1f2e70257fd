// Flow without du/dt: Darcy's through a fixed bed and Poiseuille's between walls, in one step of any length.
#include "bed.h"

#include <gtest/gtest.h>

namespace
{
  using namespace bed;

  constexpr double pressure = 5.;

  struct Case
  {
    explicit Case(const bool inertia, const double dt, const double h = 4.)
      : bed(random_bed(1, 24., 16.))
    {
      Settings settings;
      settings.h_over_d   = h;
      settings.dt         = dt;
      settings.convection = false;
      channel             = std::make_unique<Channel>(bed.width, bed.height, h * bed.d, settings, pressure);
      channel->solver.discretisation.convection = false;
      channel->solver.discretisation.inertia    = inertia;
    }

    double flux_after(const unsigned int n)
    {
      for (unsigned int i = 0; i < n; ++i)
        channel->step(bed.grains, true);
      return channel->solver.flux(3);
    }

    Bed                      bed;
    std::unique_ptr<Channel> channel;
  };

  TEST(FlowWithoutInertia, IsDarcysInOneStepOfAnyLength)
  {
    Case         with(true, 1e-2);
    const double reference = with.flux_after(60);
    const double darcy =
      with.bed.width * darcy_velocity(with.bed, with.channel->coupling.drag_law(), pressure / with.bed.height);
    EXPECT_NEAR(reference / darcy, 1., 0.01);
    double first = 0.;
    for (const double dt : {1e-6, 1e-3, 10.})
      {
        Case         without(false, dt);
        const double flux = without.flux_after(1);
        EXPECT_NEAR(flux / reference, 1., 1e-3) << dt;
        if (first == 0.)
          first = flux;
        EXPECT_NEAR(flux / first, 1., 1e-5) << dt;
        EXPECT_NEAR(without.channel->solver.flux(2) / flux, -1., 1e-5);
      }
  }

  TEST(FlowWithoutInertia, CostsNothingUntilItsBoundariesChange)
  {
    Case         without(false, 1e-3);
    const double first  = without.flux_after(1);
    const auto  &report = without.channel->coupling.report();
    EXPECT_FALSE(report.steady);
    const double flux = without.flux_after(1); // the last digits
    EXPECT_FALSE(report.steady);
    EXPECT_NEAR(flux / first, 1., 2e-4);
    EXPECT_EQ(without.flux_after(1), flux);
    EXPECT_TRUE(report.steady);
    EXPECT_EQ(report.n_iterations, 0u);
    without.channel->settings.dt = 0.5; // nothing depends on it
    EXPECT_EQ(without.flux_after(1), flux);
    EXPECT_TRUE(report.steady);
    without.channel->set_pressure_below(2. * pressure);
    const double twice = without.flux_after(1);
    EXPECT_FALSE(report.steady);
    EXPECT_GT(twice / flux, 1.8); // less than twice: drag grows with speed
    EXPECT_LT(twice / flux, 1.999);
    without.channel->coupling.forget_steady();
    without.flux_after(1);
    EXPECT_FALSE(report.steady);
  }

  TEST(FlowWithoutInertia, GivesFixedGrainsTheForceOfTheHead)
  {
    // what the pressures push, the grains hold: the walls slip
    Case without(false, 1e-3);
    without.flux_after(1);
    const auto &report = without.channel->coupling.report();
    EXPECT_NEAR(report.force_on_grains[1] / (pressure * without.bed.width), 1., 1e-2);
  }

  TEST(FlowWithoutInertia, OfMovingGrainsIsStableAndStationary)
  {
    // glycerine: the fluid stops by itself in a few microseconds, so that inertia changes nothing
    const auto speed_after = [](const bool inertia) {
      Case scene(inertia, 1e-3);
      scene.channel->solver.properties = {1260., 1.5};
      for (unsigned int i = 0; i < 20; ++i)
        scene.channel->step(scene.bed.grains, false);
      return scene.channel->solver.flux(3);
    };
    const double with = speed_after(true);
    EXPECT_NE(with, 0.);
    EXPECT_NEAR(speed_after(false) / with, 1., 1e-3);
  }

  TEST(FlowWithoutViscousStress, IsDarcysToo)
  {
    Case         with(false, 1e-3), without(false, 1e-3);
    const double flux                                = with.flux_after(1);
    without.channel->solver.discretisation.viscosity = false;
    EXPECT_NEAR(without.flux_after(1) / flux, 1., 1e-3);
  }
} // namespace
