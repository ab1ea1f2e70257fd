// A step that is taken back and tried again.
#include "contact_scene.h"

#include <gtest/gtest.h>

using namespace alluvium::contacts;
using namespace alluvium::grains;
using test::Scene;

namespace
{
  /** A small heap that falls onto a floor which moves. */
  void fill(Scene &scene, const std::string &parameters)
  {
    scene.set(parameters);
    scene.stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.05}}, "floor"}});
    for (int row = 0; row < 4; ++row)
      for (int k = 0; k < 6; ++k)
        scene.add((1.02 * k + 0.37 * (row % 2)) * test::d, (0.6 + 0.95 * row) * test::d, 0.01 * k, -0.1);
    scene.step(1e-4, 40);
  }

  /** What a step gives with and without a try before it, under other loads. */
  void expect_same(const std::string &parameters, const double tolerance)
  {
    Scene once, twice;
    fill(once, parameters);
    fill(twice, parameters);
    const GrainArrays   start  = twice.grains;
    const ContactMemory memory = twice.stepper.memory();
    twice.gx                   = 3. * test::g;
    twice.step(1e-3);
    EXPECT_GT(std::abs(twice.grains.position[0][0] - start.position[0][0]), 1e-9);
    twice.grains = start;
    twice.gx     = 0.;
    twice.stepper.restore(memory);
    once.step(1e-3);
    twice.step(1e-3);
    EXPECT_EQ(once.stepper.walls()[0].a[1], twice.stepper.walls()[0].a[1]);
    for (std::size_t k = 0; k < start.n(); ++k)
      {
        EXPECT_NEAR(once.grains.velocity[0][k], twice.grains.velocity[0][k], tolerance) << parameters;
        EXPECT_NEAR(once.grains.velocity[1][k], twice.grains.velocity[1][k], tolerance) << parameters;
        EXPECT_NEAR(once.grains.position[0][k], twice.grains.position[0][k], 1e-3 * tolerance);
      }
  }
} // namespace

TEST(ContactMemory, ContactsWithoutHistory)
{
  // the impulses of the try are a first guess only
  expect_same("set Residual tolerance = 1e-12\nset Largest violation = 1e-10", 1e-9);
}

TEST(ContactMemory, SpringsAndBondsForgetTheTry)
{
  expect_same("set Contact model = soft-sphere", 1e-12);
  expect_same("set Cohesion = liquid bridge\nset Residual tolerance = 1e-12\nset Largest violation = 1e-10", 1e-9);
}

TEST(ContactMemory, RestIsNotBrokenByATry)
{
  Scene scene;
  scene.set("");
  scene.floor();
  scene.add(0., test::r);
  scene.step(1e-3, 30);
  ASSERT_TRUE(scene.report.at_rest);
  const GrainArrays   start  = scene.grains;
  const ContactMemory memory = scene.stepper.memory();
  scene.gx                   = test::g;
  scene.step(1e-3);
  EXPECT_FALSE(scene.report.at_rest);
  scene.gx     = 0.;
  scene.grains = start;
  scene.stepper.restore(memory);
  scene.step(1e-3);
  EXPECT_TRUE(scene.report.at_rest);
}
