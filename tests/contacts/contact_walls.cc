// Walls that move and rotate, against exact answers.
#include <gtest/gtest.h>

#include "contact_scene.h"

using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  /** A square drum around the origin with an inner radius of @p a, turning at @p spin. */
  std::vector<WallSegment> drum(const double a, const double spin)
  {
    const std::array<std::array<double, 2>, 4> corner{{{{-a, -a}}, {{a, -a}}, {{a, a}}, {{-a, a}}}};
    std::vector<WallSegment>                   walls;
    for (int k = 0; k < 4; ++k)
      walls.push_back({corner[k], corner[(k + 1) % 4], {{0., 0.}}, "drum", spin, {{0., 0.}}});
    return walls;
  }
} // namespace

TEST(MovingWalls, RotationIsExact)
{
  Scene s;
  s.stepper.set_walls(drum(10. * d, 20.));
  s.add(0., 0.);
  s.gy = 0.;
  s.step(1e-4, 500); // one radian
  const auto  &wall = s.stepper.walls()[0];
  const double a = 10. * d, c = std::cos(1.), sn = std::sin(1.);
  EXPECT_NEAR(wall.a[0], -c * a + sn * a, 1e-12);
  EXPECT_NEAR(wall.a[1], -sn * a - c * a, 1e-12);
  EXPECT_EQ(s.grains.velocity[0][0], 0.);
}

// A paddle gives a disc the speed that it has where it touches.
TEST(MovingWalls, PaddlePushes)
{
  Scene s;
  s.exact();
  s.gy = 0.;
  s.set("set Wall friction coefficient = 0");
  s.exact();
  s.stepper.set_walls({{{{0., 0.}}, {{20. * d, 0.}}, {{0., 0.}}, "paddle", 3., {{0., 0.}}}});
  s.add(12. * d, r);
  s.step(1e-5);
  EXPECT_NEAR(s.grains.velocity[1][0], 3. * 12. * d, 1e-12);
  EXPECT_NEAR(s.grains.velocity[0][0], 0., 1e-12);
  // a translation of the centre adds to it
  s.stepper.set_walls({{{{0., 0.}}, {{20. * d, 0.}}, {{0., 0.2}}, "paddle", 3., {{0., 0.}}}});
  s.grains.velocity[1][0] = 0.;
  s.grains.position[0][0] = 12. * d;
  s.grains.position[1][0] = r;
  s.step(1e-5);
  EXPECT_NEAR(s.grains.velocity[1][0], 0.2 + 3. * 12. * d, 1e-12);
  EXPECT_NEAR(s.stepper.walls()[0].centre[1], 0.2e-5, 1e-18);
}

// A disc that turns with its drum stays where it is on it, and is held by the centripetal force.
TEST(MovingWalls, RestsInARotatingDrum)
{
  double error[2];
  for (int level = 0; level < 2; ++level)
    {
      Scene        s;
      const double a = 10. * d, l = a - r, spin = 20., dt = level == 0 ? 1e-4 : 2.5e-5;
      s.set("set Wall friction coefficient = 1\nset Rolling friction coefficient = 0.2");
      s.exact();
      s.gy = 0.;
      s.stepper.set_walls(drum(a, spin));
      s.add(0., -l, spin * l, 0.);
      s.grains.omega[0] = spin;
      const int n       = static_cast<int>(std::lround(M_PI / spin / dt)); // half a turn
      s.step(dt, n);
      const double angle = spin * n * dt, x = l * std::sin(angle), y = -l * std::cos(angle);
      error[level] = std::hypot(s.grains.position[0][0] - x, s.grains.position[1][0] - y) / d;
      EXPECT_NEAR(s.grains.omega[0], spin, 0.01 * spin);
      const double force = std::hypot(s.report.wall_force["drum"][0], s.report.wall_force["drum"][1]);
      EXPECT_NEAR(force / (s.grains.mass[0] * spin * spin * l), 1., 0.02);
      EXPECT_EQ(s.report.n_contacts, 1u);
    }
  EXPECT_LT(error[0], 0.1);
  EXPECT_LT(error[1], 0.3 * error[0]); // first order in the step
}

// In a corner of the drum: two contacts, and a disc on the joint of two parallel walls still feels one.
TEST(MovingWalls, CornersOfMovingWallsCountOnce)
{
  Scene s;
  s.exact();
  s.set("set Wall friction coefficient = 0");
  s.stepper.settings().dead_zone = 0.;
  s.stepper.set_walls({{{{-1., 0.}}, {{0., 0.}}, {{0., 0.1}}, "left"}, {{{0., 0.}}, {{1., 0.}}, {{0., 0.1}}, "right"}});
  s.add(0., r);
  s.step(1e-4, 5);
  EXPECT_EQ(s.report.n_contacts, 1u);
  EXPECT_NEAR(s.grains.velocity[1][0], 0.1, 1e-9);
}

TEST(MovingWalls, ComeBackFromTheArchive)
{
  const auto run = [](const bool restart) {
    Scene first, second;
    for (Scene *s : {&first, &second})
      s->stepper.set_walls(drum(3. * d, 30.));
    first.add(0., -2.5 * d);
    first.add(0.2 * d, -1.4 * d);
    first.step(1e-4, 50);
    first.stepper.forget_search();
    Scene &s = restart ? second : first;
    if (restart)
      {
        second.grains = first.grains;
        second.stepper.set_archive(first.stepper.archive());
      }
    s.step(1e-4, 50);
    return s.grains;
  };
  const GrainArrays whole = run(false), restarted = run(true);
  EXPECT_EQ(whole.position[0], restarted.position[0]);
  EXPECT_EQ(whole.velocity[1], restarted.velocity[1]);
  EXPECT_EQ(whole.omega, restarted.omega);
}
