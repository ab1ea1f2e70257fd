// Contacts that are left out: grains fly as they do without any, and contacts are there before something meets.
#include "contact_scene.h"

#include <gtest/gtest.h>

using namespace alluvium::contacts;
using namespace alluvium::contacts::test;

namespace
{
  /** Grains with room between them, which drag holds up more or less. */
  void fill(Scene &scene)
  {
    scene.floor();
    for (int i = 0; i < 5; ++i)
      {
        scene.add(3. * i * d, 40. * d + i * d, 0.01 * i, -0.02 * i);
        scene.loads.drag.push_back(0.1 * i);
      }
  }
} // namespace

TEST(FreeFlight, IsWhatContactsMakeOfGrainsThatTouchNothing)
{
  Scene with, without;
  for (Scene *scene : {&with, &without})
    fill(*scene);
  without.stepper.leave_out(true);
  with.step(1e-3, 40);
  without.step(1e-3, 40);
  EXPECT_TRUE(without.stepper.are_left_out());
  for (std::size_t k = 0; k < with.grains.n(); ++k)
    for (unsigned int c = 0; c < 2; ++c)
      {
        EXPECT_EQ(with.grains.position[c][k], without.grains.position[c][k]);
        EXPECT_EQ(with.grains.velocity[c][k], without.grains.velocity[c][k]);
        EXPECT_EQ(without.grains.contact_force[c][k], 0.);
      }
  EXPECT_EQ(with.report.n_substeps, without.report.n_substeps);
  EXPECT_EQ(without.report.wall_force.at("floor")[1], 0.);
}

TEST(FreeFlight, EndsBeforeGrainsMeet)
{
  Scene with, without;
  for (Scene *scene : {&with, &without})
    {
      scene->gx = scene->gy = 0.;
      scene->add(0., 0., 0.1, 0.);
      scene->add(3. * d, 0.1 * d, -0.1, 0.);
    }
  without.stepper.leave_out(true);
  bool         met     = false;
  unsigned int n_steps = 0;
  while (n_steps < 30)
    {
      with.step(1e-3);
      without.step(1e-3);
      ++n_steps;
      const double distance = std::hypot(without.grains.position[0][1] - without.grains.position[0][0],
                                         without.grains.position[1][1] - without.grains.position[1][0]);
      EXPECT_GT(distance, d * (1. - 1e-3));
      if (without.report.n_contacts > 0)
        {
          met = true;
          EXPECT_FALSE(without.stepper.are_left_out());
        }
    }
  EXPECT_TRUE(met);
  EXPECT_FALSE(without.stepper.are_left_out());
  for (unsigned int c = 0; c < 2; ++c)
    EXPECT_NEAR(without.grains.velocity[c][0], with.grains.velocity[c][0], 1e-12);
}

TEST(FreeFlight, EndsBeforeAGrainMeetsAWall)
{
  Scene scene;
  scene.floor();
  scene.add(0., 3. * d);
  scene.stepper.leave_out(true);
  scene.step(1e-3, 5);
  EXPECT_TRUE(scene.stepper.are_left_out());
  scene.step(1e-3, 100);
  EXPECT_FALSE(scene.stepper.are_left_out());
  EXPECT_NEAR(scene.grains.position[1][0], r, 1e-3 * d);
  EXPECT_NEAR(scene.report.wall_force.at("floor")[1], -scene.grains.mass[0] * g, 1e-6 * scene.grains.mass[0] * g);
}

TEST(FreeFlight, IsNotForWhatActsFromAfar)
{
  Scene plain, soft, sticky, moving;
  plain.floor();
  EXPECT_TRUE(plain.stepper.may_be_left_out());
  soft.set("set Contact model = soft-sphere");
  EXPECT_FALSE(soft.stepper.may_be_left_out());
  sticky.set("set Cohesion = constant force\nsubsection Cohesion: constant force\nset Force = 1e-3\nend");
  EXPECT_FALSE(sticky.stepper.may_be_left_out());
  moving.floor({{1., 0.}});
  EXPECT_FALSE(moving.stepper.may_be_left_out());
}
