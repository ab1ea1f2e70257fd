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
      measures.energy = {kinetic, change, sources, change - sources};
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
  scene.model.grains.vx[0] = std::numeric_limits<double>::quiet_NaN();
  const Sign sign          = scene.step(std::numeric_limits<double>::quiet_NaN(), 0.);
  EXPECT_NE(sign.what.find("not a number"), std::string::npos);
  EXPECT_EQ(sign.near, "grain 0");
}
