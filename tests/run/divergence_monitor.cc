#include <alluvium/run/divergence_monitor.h>
#include <alluvium/run/model.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace alluvium;
using namespace alluvium::run;

namespace
{
  /** One dry grain of 1 kg/m that does not move by itself: the measures are made up. */
  struct Scene
  {
    Model             model{MPI_COMM_SELF};
    DivergenceMonitor monitor;
    double            kinetic = 1.; // [J/m]

    Scene()
    {
      model.has_fluid = model.grains_move = false;
      model.gravity                       = {{0., -9.81}};
      model.grains.resize(1);
      model.grains.radius[0] = 1e-3;
      model.grains.mass[0]   = 1.;
    }

    Sign step(const double change, const double sources)
    {
      kinetic += change;
      StepMeasures measures;
      measures.energy         = {kinetic, 0., change, sources, change - sources};
      measures.grain_velocity = std::sqrt(2. * kinetic);
      return monitor.judge(model, measures);
    }
  };
} // namespace

TEST(DivergenceMonitor, BelievesWhatWorkExplains)
{
  Scene scene;
  for (unsigned int n = 0; n < 100; ++n) // with the errors of a discretisation
    {
      const double work = 0.1 * (n + 1);
      EXPECT_EQ(scene.step(n % 2 == 0 ? 1.2 * work : 0.9 * work, work).what, "");
      EXPECT_TRUE(scene.monitor.is_calm());
    }
  for (unsigned int n = 0; n < 100; ++n) // supplied and dissipated at once
    EXPECT_EQ(scene.step(0., 10.).what, "");
}

TEST(DivergenceMonitor, NoticesARunAwayWithinSomeSteps)
{
  Scene scene;
  for (unsigned int n = 0; n < 100; ++n)
    EXPECT_EQ(scene.step(0., 0.1).what, "");
  unsigned int n_steps = 0;
  Sign         sign;
  while (sign.what.empty() && ++n_steps < 100)
    sign = scene.step(0.3 * scene.kinetic, 0.1);
  EXPECT_LE(n_steps, 5u);
  EXPECT_EQ(sign.near, "grain 0");
  EXPECT_GT(sign.value, sign.bound);
  EXPECT_FALSE(scene.monitor.is_calm());
  const std::string text = in_words(sign, scene.model.n_steps, scene.model.time);
  EXPECT_NE(text.find("energy"), std::string::npos) << text;
  EXPECT_NE(text.find("Try a smaller Time/Time step"), std::string::npos) << text;
}

TEST(DivergenceMonitor, GoesCalmAgain)
{
  Scene scene;
  EXPECT_EQ(scene.step(0.4, 0.).what, ""); // an impact that numerics made too strong
  EXPECT_FALSE(scene.monitor.is_calm());
  EXPECT_EQ(scene.step(-0.3, 0.).what, "");
  EXPECT_TRUE(scene.monitor.is_calm());
}

TEST(DivergenceMonitor, SeesWhatIsNoNumber)
{
  Scene scene;
  scene.model.grains.velocity[0][0] = std::numeric_limits<double>::quiet_NaN();
  const Sign sign                   = scene.step(std::numeric_limits<double>::quiet_NaN(), 0.);
  EXPECT_NE(sign.what.find("not a number"), std::string::npos);
  EXPECT_EQ(sign.near, "grain 0");
}

TEST(DivergenceMonitor, ABounceIsNoRunAway)
{
  Scene        scene;
  unsigned int n_bounces = 0;
  for (double v = -std::sqrt(2.); n_bounces < 20; v -= 9.81e-3)
    {
      double sources = scene.kinetic;
      if (v <
          -std::sqrt(2.)) // the time of an impact is known to a part of a step: with error for one, less for another
        {
          v *= -1.;
          sources += (n_bounces % 2 == 0 ? -1. : 1.) * 9.81e-3 * v;
          ++n_bounces;
        }
      EXPECT_EQ(scene.step(0.5 * v * v - scene.kinetic, 0.5 * v * v - sources).what, "");
    }
}

TEST(DivergenceMonitor, ForgetsWhatItFlewWith)
{
  Scene scene;
  EXPECT_EQ(scene.step(0., 0.).what, "");
  EXPECT_EQ(scene.step(-0.99, 0.).what, "");
  for (unsigned int n = 0; n < 10000; ++n) // 10 s, of flights of 0.3 s at most
    EXPECT_EQ(scene.step(0., 0.).what, "");
  unsigned int n_steps = 0;
  while (scene.step(0.3 * scene.kinetic, 0.).what.empty() && n_steps < 100)
    ++n_steps;
  EXPECT_LE(n_steps, 5u);
}

TEST(DivergenceMonitor, WithoutGravityOverlapsOpen)
{
  Scene scene;
  scene.model.gravity   = {{0., 0.}};
  scene.model.time_step = 1e-3;
  scene.kinetic         = 0.;
  EXPECT_EQ(scene.step(1e-6, 0.).what, ""); // 1.4 mm/s, of d/dt = 2 m/s
  unsigned int n_steps = 0;
  while (scene.step(0.3 * scene.kinetic, 0.).what.empty() && n_steps < 100)
    ++n_steps;
  EXPECT_LE(n_steps, 10u);
}
