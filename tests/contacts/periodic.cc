// Grains in a box that repeats itself.
#include <alluvium/contacts/rest.h>
#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  Periodicity box(const double lx, const double ly = 0.)
  {
    return {{{0., 0.}}, {{lx, ly}}};
  }
} // namespace

// Grains keep their velocity, and their displacement knows how often they went around.
TEST(Periodic, CrossingKeepsMomentum)
{
  Scene s;
  s.gy = 0.;
  s.stepper.set_periodicity(box(10. * d, 7. * d));
  s.add(d, d, 0.37, -0.21);
  s.grains.initial_position[0][0] = d;
  s.grains.initial_position[1][0] = d;
  s.step(1e-3, 200);
  EXPECT_EQ(s.grains.velocity[0][0], 0.37);
  EXPECT_EQ(s.grains.velocity[1][0], -0.21);
  EXPECT_NEAR(s.grains.position[0][0] - s.grains.initial_position[0][0], 0.37 * 0.2, 1e-13);
  EXPECT_NEAR(s.grains.position[1][0] - s.grains.initial_position[1][0], -0.21 * 0.2, 1e-13);
  EXPECT_GE(s.grains.position[0][0], 0.);
  EXPECT_LT(s.grains.position[0][0], 10. * d);
  EXPECT_NEAR(s.grains.position[0][0], std::fmod(d + 0.37 * 0.2, 10. * d), 1e-13);
}

// Two discs meet across the side, head on without loss: they swap velocities.
TEST(Periodic, CollisionAcrossTheSide)
{
  for (const bool in_y : {false, true})
    {
      Scene s;
      s.gy                             = 0.;
      s.stepper.settings().restitution = 1.;
      s.stepper.set_periodicity(in_y ? box(0., 10. * d) : box(10. * d));
      in_y ? s.add(0., 0.7 * d, 0., -0.5) : s.add(0.7 * d, 0., -0.5);
      in_y ? s.add(0., 9. * d, 0., 0.25) : s.add(9. * d, 0., 0.25);
      s.step(1e-4, 20);
      const auto &v = in_y ? s.grains.velocity[1] : s.grains.velocity[0];
      EXPECT_NEAR(v[0], 0.25, 1e-12);
      EXPECT_NEAR(v[1], -0.5, 1e-12);
    }
}

// Three discs in a row: the first hits the second, and only that makes the second hit the third, within the same step.
// The numbers are the same wherever the periodic boundary is.
TEST(Periodic, CradleAcrossTheSide)
{
  const double length = 20. * d;
  for (const double restitution : {0., 0.5, 1.})
    for (const bool in_y : {false, true})
      {
        const auto run = [&](const double start) {
          Scene s;
          s.gy                                    = 0.;
          s.stepper.settings().restitution        = restitution;
          s.stepper.settings().threshold_velocity = 0.;
          s.stepper.set_periodicity(in_y ? box(0., length) : box(length));
          for (const double x : {0., 1.02 * d, 2.17 * d})
            {
              const double place = std::fmod(start + x, length), v = x == 0. ? 0.5 : 0.;
              in_y ? s.add(0., place, 0., v) : s.add(place, 0., v);
            }
          s.step(4.8e-4, 2);
          return in_y ? s.grains.velocity[1] : s.grains.velocity[0];
        };
        const std::vector<double> inside = run(5. * d);
        EXPECT_GT(inside[2], 0.); // the third has been hit
        for (const double start : {19.5 * d, 18.4 * d})
          {
            const std::vector<double> across = run(start);
            for (int k = 0; k < 3; ++k)
              EXPECT_NEAR(across[k], inside[k], 1e-9)
                << "disc " << k << ", restitution " << restitution << (in_y ? ", in y" : ", in x");
          }
      }
}

// What rests on the periodic boundary itself, now on this side of it, now on that, rests.
TEST(Periodic, RestOnThePeriodicBoundary)
{
  const double       length = 10. * d;
  Rest               rest;
  GrainArrays        grains;
  GrainLoads         loads;
  ContactReport      report;
  const Rest::Scales scales{1e-3, g, 1., d};
  grains.resize(1);
  grains.radius[0] = r;
  loads.reset(1);
  rest.periodicity = box(length, length);
  const std::vector<std::uint8_t> touched(1, 1);
  for (unsigned int k = 0; k < rest.steps; ++k)
    {
      grains.position[0][0] = k % 2 ? 0. : length * (1. - 1e-15);
      grains.position[1][0] = k % 3 ? 0. : length * (1. - 1e-15);
      rest.watch(grains, loads, scales, touched, report);
    }
  EXPECT_TRUE(rest.holds(grains, loads, scales));
  grains.position[0][0] = 0.5 * length;
  EXPECT_FALSE(rest.holds(grains, loads, scales));
}

// A pair pressed together across the side and sheared: friction takes mu F from each until they roll on each other.
TEST(Periodic, ShearOfAPair)
{
  const double force = 0.5, v0 = 0.1, dt = 1e-6, mu = 0.4;
  Scene        across, inside;
  for (Scene *s : {&across, &inside})
    {
      s->exact();
      s->gy = 0.;
      s->stepper.set_periodicity(box(10. * d));
      const double x = s == &across ? 0. : 5. * d;
      s->add(x + 0.5 * d, 0., 0., v0);
      s->add(x == 0. ? 9.5 * d : x - 0.5 * d, 0., 0., -v0);
      s->loads.drag.assign(2, 0.);
      s->loads.force[0] = {-force, force};
      s->loads.force[1] = {0., 0.};
    }
  const double m    = across.grains.mass[0];
  const auto   step = [&](Scene &s) { s.report = s.stepper.advance(s.grains, s.loads, dt, {{0., 0.}}); };
  step(across);
  step(inside);
  EXPECT_NEAR(across.grains.velocity[1][0], v0 - mu * force * dt / m, 1e-12);
  EXPECT_NEAR(across.grains.velocity[1][1], -v0 + mu * force * dt / m, 1e-12);
  EXPECT_NEAR(r * across.grains.omega[0], 2. * mu * force * dt / m, 1e-12);
  EXPECT_NEAR(r * across.grains.omega[1], 2. * mu * force * dt / m, 1e-12);
  for (int k = 0; k < 200; ++k)
    {
      step(across);
      step(inside);
    }
  EXPECT_LT(across.grains.velocity[1][0], 0.9 * v0);
  for (int k = 0; k < 2; ++k)
    {
      EXPECT_NEAR(across.grains.velocity[0][k], inside.grains.velocity[0][k], 1e-10);
      EXPECT_NEAR(across.grains.velocity[1][k], inside.grains.velocity[1][k], 1e-10);
      EXPECT_NEAR(r * across.grains.omega[k], r * inside.grains.omega[k], 1e-10);
    }
}

// A bed without side walls: the floor carries all of it, grains interact across the side, and none is lost.
TEST(Periodic, FloorCarriesTheBed)
{
  Scene        s;
  const double width = 8. * 1.05 * d;
  s.stepper.set_periodicity(box(width));
  s.stepper.set_walls({{{{0., 0.}}, {{width, 0.}}, {{0., 0.}}, "floor"}});
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 8; ++column)
      {
        const double disorder = 0.02 * d * std::sin(12.9898 * row + 78.233 * column);
        s.add((column + 0.5 * (row % 2)) * 1.05 * d + disorder + 0.03 * d,
              r + row * 0.95 * d,
              0.,
              0.,
              r * (0.95 + 0.04 * std::sin(5. * row + column)));
      }
  s.stepper.settings().residual_tolerance = 1e-8;
  s.stepper.settings().stagnation_factor  = 1.;
  s.step(2e-4, 1500);
  EXPECT_LT(s.report.max_velocity, 1e-3);
  EXPECT_NEAR(s.report.wall_force["floor"][1] / -s.weight(), 1., 1e-2 * s.report.max_velocity / 1e-3 + 1e-6);
  EXPECT_LT(s.report.max_penetration, 1e-3 * d);
  double momentum = 0.;
  for (std::size_t k = 0; k < s.grains.n(); ++k)
    {
      EXPECT_GE(s.grains.position[0][k], 0.);
      EXPECT_LT(s.grains.position[0][k], width);
      EXPECT_GT(s.grains.position[1][k], 0.9 * s.grains.radius[k]);
      momentum += s.grains.mass[k] * s.grains.velocity[0][k];
    }
  EXPECT_TRUE(find_overlaps(s.grains, s.stepper.walls(), 2e-3 * d, box(width)).empty());
  EXPECT_LT(std::abs(momentum), 1e-6);
}

// Every image pair is found once, also where the box is only a few cells wide.
TEST(Periodic, SearchFindsAllPairs)
{
  for (const double lx : {3., 4., 7.3, 20.})
    for (const double ly : {0., 3., 9.1})
      {
        GrainArrays       grains;
        const std::size_t n = 60;
        grains.resize(n);
        for (std::size_t k = 0; k < n; ++k)
          {
            grains.id[k]          = k;
            grains.position[0][k] = std::fmod(0.754877666 * (k + 1), 1.) * lx * d;
            grains.position[1][k] = std::fmod(0.569840291 * (k + 1), 1.) * (ly > 0. ? ly : 5.) * d;
            grains.radius[k]      = (0.3 + 0.2 * std::fmod(0.618 * k, 1.)) * d;
          }
        ContactGeometry geometry;
        geometry.periodicity          = box(lx * d, ly * d);
        const double            skin  = 0.2 * d;
        const ContactCandidates found = find_candidates(grains, geometry, skin);
        std::size_t             next  = 0;
        for (std::uint32_t i = 0; i < n; ++i)
          for (std::uint32_t j = i + 1; j < n; ++j)
            if (touch(grains, geometry.periodicity, i, j).gap < skin)
              {
                ASSERT_LT(next, found.discs.size());
                ASSERT_EQ(found.discs[next].i, i);
                ASSERT_EQ(found.discs[next].j, j);
                ++next;
              }
        EXPECT_EQ(next, found.discs.size()) << lx << ' ' << ly;
      }
}

TEST(Periodic, NarrowBoxIsRefused)
{
  Scene s;
  s.stepper.set_periodicity(box(2.1 * d));
  s.add(d, d);
  EXPECT_THROW(s.step(1e-4), UserError);
}

// Nor is one that grains at rest have room in, but not fast ones: that is no mistake in the scene, but a step too long.
TEST(Periodic, NarrowBoxForFastGrains)
{
  const auto fall = [](const double speed) {
    Scene s;
    s.gy                          = 0.;
    s.stepper.settings().max_move = 10.;
    s.stepper.set_periodicity(box(6. * d));
    s.add(d, d, speed);
    s.add(4. * d, d, speed);
    s.step(1e-3);
    return s.grains.position[0][0];
  };
  // 1.2 times the reach of both, 2 v dt, does not fit into 3 d - d; the reach itself does
  EXPECT_NEAR(fall(0.9 * d / 1e-3), 1.9 * d, 1e-9 * d);
  EXPECT_THROW(fall(1.2 * d / 1e-3), Divergence);
}

// A grain near the side touches what stands at the other one.
TEST(Periodic, ImagesOfWalls)
{
  const std::vector<WallSegment> post{{{{9.8 * d, -5. * d}}, {{9.8 * d, 5. * d}}, {{0., 0.}}, "post"}};
  EXPECT_EQ(with_images(post, box(10. * d)).size(), 3u);
  EXPECT_EQ(with_images(post, box(10. * d, 20. * d)).size(), 9u);
  Scene s;
  s.exact();
  s.gx = -g;
  s.gy = 0.;
  s.stepper.set_periodicity(box(10. * d));
  s.stepper.set_walls(with_images(post, box(10. * d)));
  s.add(0.3 * d, 0.);
  s.step(1e-4, 10);
  EXPECT_NEAR(s.grains.velocity[0][0], 0., 1e-10);
  EXPECT_NEAR(s.report.wall_force["post"][0] / -s.weight(), 1., 1e-10);
}
