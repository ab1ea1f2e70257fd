// Deposits respect what stands in their box: piles, slopes, obstacles, extra walls.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_box.h>
#include <alluvium/deposits/deposit_room.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/user_error.h>

#include "deposits_made.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::deposits;
using namespace alluvium::grains;

namespace
{
  constexpr double d = 2e-4; // the smallest diameter

  /** A box of 6 mm x 8 mm with a floor and sides, and @p walls in it. */
  DepositContext context(const std::vector<WallSegment> &walls)
  {
    DepositContext c;
    c.lower   = {{0., 0.}};
    c.upper   = {{6e-3, 8e-3}};
    c.density = 2630.;
    c.gravity = {{0., -9.81}};
    c.walls   = {{{{0., 8e-3}}, {{0., 0.}}, {{0., 0.}}, "left"},
                 {{{0., 0.}}, {{6e-3, 0.}}, {{0., 0.}}, "bottom"},
                 {{{6e-3, 0.}}, {{6e-3, 8e-3}}, {{0., 0.}}, "right"}};
    c.walls.insert(c.walls.end(), walls.begin(), walls.end());
    return c;
  }

  WallSegment wall(const double x0, const double y0, const double x1, const double y1)
  {
    return {{{x0, y0}}, {{x1, y1}}, {{0., 0.}}, "wall"};
  }

  std::vector<WallSegment> polygon(const std::vector<std::array<double, 2>> &corners)
  {
    std::vector<WallSegment> result;
    for (std::size_t k = 0; k < corners.size(); ++k)
      result.push_back({corners[k], corners[(k + 1) % corners.size()], {{0., 0.}}, "obstacle"});
    return result;
  }

  using test::arrays, test::make;

  /** Nobody overlaps a wall or another; and let go, hardly anybody moves. */
  void expect_at_rest(const std::vector<NewGrain> &new_grains, const DepositContext &c)
  {
    GrainArrays grains = arrays(new_grains);
    EXPECT_TRUE(find_overlaps(grains, c.walls, 1e-3 * d).empty());
    ContactStepper stepper;
    stepper.set_walls(c.walls);
    GrainLoads loads;
    loads.reset(grains.n());
    for (std::size_t k = 0; k < grains.n(); ++k)
      loads.force[1][k] = -grains.mass[k] * 9.81;
    for (int step = 0; step < 20; ++step)
      stepper.advance(grains, loads, 5e-4, {{0., -9.81}});
    int moved = 0;
    for (std::size_t k = 0; k < grains.n(); ++k)
      moved += std::hypot(grains.position[0][k] - new_grains[k].x, grains.position[1][k] - new_grains[k].y) > 0.01 * d;
    EXPECT_LE(moved, static_cast<int>(grains.n() / 100));
  }

  /** Packing in a rectangle, by a raster. */
  double
  packing(const std::vector<NewGrain> &new_grains, const double x0, const double y0, const double x1, const double y1)
  {
    int          inside = 0, all = 0;
    const double h = 2e-5;
    for (double y = y0; y < y1; y += h)
      for (double x = x0; x < x1; x += h, ++all)
        inside += std::any_of(new_grains.begin(), new_grains.end(), [&](const NewGrain &s) {
          return std::hypot(s.x - x, s.y - y) < s.radius;
        });
    return double(inside) / all;
  }

  const std::string bed = "set Number of grains = 600\nset Cache folder =\n";
} // namespace


TEST(DepositsAmongWalls, WhatDoesNotReachTheBedChangesNothing)
{
  const auto plain = make("settled bed", bed, context({})),
             lid   = make("settled bed", bed, context({wall(0., 7e-3, 6e-3, 7e-3)}));
  ASSERT_EQ(plain.size(), lid.size());
  for (std::size_t k = 0; k < plain.size(); ++k)
    EXPECT_LT(std::hypot(plain[k].x - lid[k].x, plain[k].y - lid[k].y), 1e-3 * d);
}

// The area of a room is exact, wherever its corners and the box's are.
TEST(DepositsAmongWalls, AreaOfTheRoom)
{
  const double   y = 1e-3 / 3.;
  DepositContext c = context({});
  c.walls.clear();
  c.sides = polygon({{{0., 0.}}, {{6e-3, 0.}}, {{6e-3, y}}, {{3e-3, 8e-3}}, {{0., y}}});
  const DepositRoom all(c, {c.lower, c.upper}, 0.5 * d, 0.5 * d);
  EXPECT_NEAR(all.area() / (6e-3 * y + 3e-3 * (8e-3 - y)), 1., 1e-12);
  const DepositRoom middle(c, {{{1e-3, 0.}}, {{5e-3, 8e-3}}}, 0.5 * d, 0.5 * d);
  EXPECT_NEAR(middle.area() / (4e-3 * y + 8e-3 / 3. * (8e-3 - y)), 1., 1e-12);
}

// A sheet pile from above: grains on both sides of it, and below it.
TEST(DepositsAmongWalls, Pile)
{
  const auto c          = context({wall(3e-3, 2e-3, 3e-3, 8e-3)});
  const auto new_grains = make("settled bed", bed + "set Friction while settling = 0.4", c);
  EXPECT_EQ(new_grains.size(), 600u);
  expect_at_rest(new_grains, c);
  double left = 0., right = 0.;
  for (const NewGrain &s : new_grains)
    (s.x < 3e-3 ? left : right) = std::max(s.x < 3e-3 ? left : right, s.y);
  EXPECT_NEAR(left, right, 3. * d);
  EXPECT_GT(packing(new_grains, 0.5e-3, 0.5e-3, 2.5e-3, 2.5e-3), 0.78);
}

// A slope from side to side: the bed lies on it, nobody is below.
TEST(DepositsAmongWalls, Slope)
{
  const auto c          = context({wall(0., 3e-3, 6e-3, 1e-3)});
  const auto new_grains = make("settled bed", bed, c);
  EXPECT_EQ(new_grains.size(), 600u);
  for (const NewGrain &s : new_grains)
    EXPECT_GT(s.y, 3e-3 - s.x / 3.);
  expect_at_rest(new_grains, c);
  EXPECT_GT(packing(new_grains, 2e-3, 2.8e-3, 5e-3, 4e-3), 0.78);
}

// An obstacle of the mesh, a dam, and an inclined side of the domain.
TEST(DepositsAmongWalls, ObstacleOfTheMesh)
{
  DepositContext c   = context(polygon({{{2e-3, 1e-3}}, {{2e-3, 2e-3}}, {{3.5e-3, 2.5e-3}}, {{3.5e-3, 1e-3}}}));
  const auto     dam = wall(6e-3, 2e-3, 5e-3, 0.);
  c.walls.push_back(dam);
  const auto obstacle = polygon({{{2e-3, 1e-3}}, {{2e-3, 2e-3}}, {{3.5e-3, 2.5e-3}}, {{3.5e-3, 1e-3}}});
  c.sides             = polygon({{{0., 0.}}, {{5e-3, 0.}}, {{6e-3, 2e-3}}, {{6e-3, 8e-3}}, {{0., 8e-3}}});
  c.sides.insert(c.sides.end(), obstacle.begin(), obstacle.end());
  const auto new_grains = make("settled bed", bed, c);
  EXPECT_EQ(new_grains.size(), 600u);
  expect_at_rest(new_grains, c);
  for (const NewGrain &s : new_grains)
    {
      EXPECT_FALSE(s.x > 2e-3 && s.x < 3.5e-3 && s.y > 1e-3 && s.y < 2e-3);
      EXPECT_FALSE(s.x > 5e-3 + 0.5 * s.y);
    }
  const auto by_height = make("settled bed", "set Number of grains = 0\nset Bed height = 4e-3\nset Cache folder =", c);
  double     top       = 0.;
  for (const NewGrain &s : by_height)
    top = std::max(top, s.y + s.radius);
  EXPECT_LE(top, 4e-3 + 1e-9);
  EXPECT_GT(top, 4e-3 - 2. * d);
  expect_at_rest(by_height, c);

  // Suspensions and lattices leave it out; the area fraction is that of the room there is.
  const DepositRoom room(c, {c.lower, c.upper}, 0.5 * d, 0.5 * d);
  const double      area = 6e-3 * 8e-3 - 1e-6 - (1.5e-6 + 0.5 * 1.5e-3 * 0.5e-3);
  EXPECT_NEAR(room.area(), area, 1e-12 * area);
  const auto cloud = make("random suspension", "set Area fraction = 0.3\nset Smallest gap = 1e-5", c);
  double     solid = 0.;
  for (const NewGrain &s : cloud)
    solid += M_PI * s.radius * s.radius;
  EXPECT_NEAR(solid, 0.3 * area, 0.01 * area);
  EXPECT_TRUE(find_overlaps(arrays(cloud), c.walls, -0.99e-5).empty());
  const auto lattice = make("lattice", "set Diameter = 2e-4\nset Spacing = 2.5e-4", c);
  EXPECT_TRUE(find_overlaps(arrays(lattice), c.walls, 1e-12).empty());
  EXPECT_NEAR(lattice.size() * 6.25e-8, area, 0.15 * area);
  for (const auto *list : {&cloud, &lattice})
    for (const NewGrain &s : *list)
      EXPECT_TRUE(room.fits(s.x, s.y, 0.5 * d));
}

TEST(DepositsAmongWalls, WantedPacking)
{
  const auto   c      = context({wall(3e-3, 2e-3, 3e-3, 8e-3)});
  const double wanted = 0.79;
  const auto   new_grains =
    make("settled bed", "set Number of grains = 550\nset Cache folder =\nset Packing fraction = 0.79", c);
  const double left  = packing(new_grains, 0.5e-3, 0.5e-3, 2.5e-3, 3e-3),
               right = packing(new_grains, 3.5e-3, 0.5e-3, 5.5e-3, 3e-3);
  EXPECT_NEAR(0.5 * (left + right), wanted, 0.015);
}

TEST(DepositsAmongWalls, NoWayInIsRefused)
{
  const auto c = context(polygon({{{-1e-3, -1e-3}}, {{7e-3, -1e-3}}, {{7e-3, 9e-3}}, {{-1e-3, 9e-3}}}));
  EXPECT_NO_THROW(make("settled bed", bed, c)); // beyond it
  // a lattice of walls with holes narrower than a grain
  std::vector<WallSegment> bars;
  for (int k = 0; k <= 40; ++k)
    bars.push_back(wall(k * 1.5e-4, 0., k * 1.5e-4, 8e-3));
  EXPECT_THROW(make("settled bed", bed, context(bars)), UserError);
}
