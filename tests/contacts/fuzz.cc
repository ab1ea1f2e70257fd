// Contacts: seeded random scenes, and what must hold in each of them whatever it looks like.
#include "contact_scene.h"

#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/utilities/random_numbers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using alluvium::RandomNumbers;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  using Point = std::array<double, 2>;

  /** Discs of sizes 1:5 that fly about in a random convex box with random walls inside. */
  struct RandomScene
  {
    Scene              scene;
    std::vector<Point> corners; // of the box, anticlockwise
    double             dt = 0., smallest = 0.;

    explicit RandomScene(const unsigned int seed)
      : random(seed)
    {
      ContactSettings &s = scene.stepper.settings();
      s.friction         = random.uniform(0., 1.) < 0.2 ? 0. : random.uniform(0., 1.);
      s.wall_friction    = random.uniform(0., 1.);
      s.restitution      = pick({0., 0., 0.3, 0.9});
      s.rotation         = random.uniform(0., 1.) < 0.9;
      const double pull  = pick({0., g, g, g, 10. * g});
      const double angle = random.uniform(0., 2. * M_PI);
      scene.gx           = pull * std::cos(angle);
      scene.gy           = pull * std::sin(angle);
      dt                 = pick({1e-4, 3e-4, 1e-3});

      const int           n = 5 + static_cast<int>(random.uniform(0., 50.));
      std::vector<double> radii(n);
      double              area = 0.;
      for (double &radius : radii)
        {
          radius = r * random.uniform(1., 5.);
          area += M_PI * radius * radius;
        }
      std::sort(radii.rbegin(), radii.rend());
      smallest = 2. * radii.back();
      make_walls(area / random.uniform(0.15, 0.4), radii.front());
      const double speed = random.uniform(0., 1.) * pick({0.01, 0.1, 1., 3.}), crowded = pick({0., 0.5, 1.});
      for (const double radius : radii)
        {
          Point p;
          if (place(radius, crowded, p))
            scene.add(p[0], p[1], random.uniform(-speed, speed), random.uniform(-speed, speed), radius);
        }
      for (std::size_t k = 0; k < scene.grains.n(); ++k)
        scene.grains.omega[k] = s.rotation ? random.uniform(-speed, speed) / scene.grains.radius[k] : 0.;
    }

    /** How far the centre of grain @p k is inside the box [m]; negative outside. */
    double depth(const std::size_t k) const
    {
      double inside = 1.;
      for (std::size_t c = 0; c < corners.size(); ++c)
        inside = std::min(inside, distance(c, {{scene.grains.position[0][k], scene.grains.position[1][k]}}));
      return inside;
    }

    /** Work that opening the overlaps of the start may do: the weight of all grains over each, and their speed. */
    double injected()
    {
      double sum = 0., mass = 0.;
      for (const Overlap &o : find_overlaps(scene.grains, scene.stepper.walls(), 0.))
        sum += o.depth;
      for (const double m : scene.grains.mass)
        mass += m;
      // Without gravity, the speed is a part of the fastest grain's, or of the time step's.
      double fastest = 0.01 * smallest / dt;
      for (std::size_t k = 0; k < scene.grains.n(); ++k)
        fastest = std::max(fastest, std::hypot(scene.grains.velocity[0][k], scene.grains.velocity[1][k]));
      const double pull = std::hypot(scene.gx, scene.gy), unit = pull > 0. ? std::sqrt(pull * smallest) : fastest,
                   push = scene.stepper.settings().depenetration_speed * unit;
      return sum == 0. ? 0. : 2. * scene.weight() * sum + 4. * mass * push * push;
    }

  private:
    RandomNumbers random;

    double pick(const std::vector<double> &choices)
    {
      return choices[static_cast<std::size_t>(random.uniform(0., choices.size()))];
    }

    /** Of @p p from side @p c of the box, positive inside. */
    double distance(const std::size_t c, const Point &p) const
    {
      const Point &a = corners[c], &b = corners[(c + 1) % corners.size()];
      const double ex = b[0] - a[0], ey = b[1] - a[1];
      return (ex * (p[1] - a[1]) - ey * (p[0] - a[0])) / std::hypot(ex, ey);
    }

    void make_walls(const double area, const double largest)
    {
      // Corners on a circle, not too near to each other, and the circle as large as the area wants.
      const int           n = 3 + static_cast<int>(random.uniform(0., 6.));
      std::vector<double> angles(n);
      for (int k = 0; k < n; ++k)
        angles[k] = 2. * M_PI * (k + random.uniform(0., 0.6)) / n;
      double unit = 0.;
      for (int k = 0; k < n; ++k)
        unit += 0.5 * std::sin(angles[(k + 1) % n] - angles[k]);
      const double size = std::max(std::sqrt(area / unit), 6. * largest);
      for (const double a : angles)
        corners.push_back({{size * std::cos(a), size * std::sin(a)}});
      std::vector<WallSegment> walls;
      for (int k = 0; k < n; ++k)
        walls.push_back({corners[k], corners[(k + 1) % n], {{0., 0.}}, "side " + std::to_string(k)});
      const int inner = static_cast<int>(random.uniform(0., 4.));
      for (int k = 0; k < inner; ++k)
        {
          const double a = random.uniform(0., 2. * M_PI), at = random.uniform(0., 0.3) * size,
                       b = random.uniform(0., M_PI), length = random.uniform(0.02, 0.15) * size;
          const Point middle{{at * std::cos(a), at * std::sin(a)}};
          walls.push_back({{{middle[0] - length * std::cos(b), middle[1] - length * std::sin(b)}},
                           {{middle[0] + length * std::cos(b), middle[1] + length * std::sin(b)}},
                           {{0., 0.}},
                           "inner " + std::to_string(k)});
        }
      scene.stepper.set_walls(walls);
    }

    /** A place for a disc that overlaps others by up to 10 % of the smaller diameter, more often if @p crowded. */
    bool place(const double radius, const double crowded, Point &p)
    {
      const GrainArrays &grains = scene.grains;
      const double       size   = std::hypot(corners[0][0], corners[0][1]);
      const auto allowed        = [&](const double other) { return crowded > 0. ? 0.2 * std::min(radius, other) : 0.; };
      for (int attempt = 0; attempt < 2000; ++attempt)
        {
          p = {{random.uniform(-size, size), random.uniform(-size, size)}};
          if (grains.n() > 0 && random.uniform(0., 1.) < crowded)
            {
              const auto   k     = static_cast<std::size_t>(random.uniform(0., grains.n()));
              const double reach = radius + grains.radius[k] - random.uniform(0., allowed(grains.radius[k])),
                           a     = random.uniform(0., 2. * M_PI);
              p = {{grains.position[0][k] + reach * std::cos(a), grains.position[1][k] + reach * std::sin(a)}};
            }
          bool free = true;
          for (std::size_t c = 0; free && c < corners.size(); ++c)
            free = distance(c, p) > radius - allowed(radius);
          for (std::size_t k = 0; free && k < grains.n(); ++k)
            free = std::hypot(grains.position[0][k] - p[0], grains.position[1][k] - p[1]) >
                   radius + grains.radius[k] - allowed(grains.radius[k]);
          for (const WallSegment &w : scene.stepper.walls())
            {
              const double ex = w.b[0] - w.a[0], ey = w.b[1] - w.a[1];
              const double t = std::clamp(((p[0] - w.a[0]) * ex + (p[1] - w.a[1]) * ey) / (ex * ex + ey * ey), 0., 1.);
              free = free && std::hypot(w.a[0] + t * ex - p[0], w.a[1] + t * ey - p[1]) > radius - allowed(radius);
            }
          if (free)
            return true;
        }
      return false;
    }
  };
} // namespace


TEST(Fuzz, RandomScenes)
{
  unsigned int n_grains = 0, n_overlaps = 0, n_substeps = 0, n_unconverged = 0;
  for (unsigned int seed = 1; seed <= 200; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      RandomScene  random(seed);
      Scene       &s     = random.scene;
      const double start = s.energy(), injected = random.injected();
      double       highest = start;
      n_grains += s.grains.n();
      n_overlaps += injected > 0.;
      ASSERT_GT(s.grains.n(), 1u);
      const int n_steps = std::max(static_cast<int>(0.2 / random.dt), 800);
      for (int step = 0; step < n_steps; ++step)
        {
          ASSERT_NO_THROW(s.step(random.dt)) << "step " << step;
          n_unconverged += s.report.n_unconverged;
          n_substeps += s.report.n_substeps;
          highest = std::max(highest, s.energy());
          for (std::size_t k = 0; k < s.grains.n(); ++k)
            {
              ASSERT_TRUE(std::isfinite(s.grains.position[0][k] + s.grains.position[1][k] + s.grains.velocity[0][k] +
                                        s.grains.velocity[1][k] + s.grains.omega[k]));
              ASSERT_GT(random.depth(k), 0.) << "grain " << k << " left the box in step " << step;
            }
        }
      EXPECT_LT(highest, start + injected + 1e-6 * (s.weight() * d + std::abs(start)));
      EXPECT_LT(s.report.max_penetration, 2e-3 * random.smallest);
    }
  // Grains of 25 times another's mass, wedged with high friction: a few sub-steps are taken with the best there is.
  EXPECT_LT(n_unconverged, 3e-3 * n_substeps);
  // The scenes are what they should be.
  EXPECT_GT(n_grains, 4000u);
  EXPECT_GT(n_overlaps, 80u);
}


// What random scenes have found, in small.

// A disc that overlaps both sides of a wedge so narrow that friction locks it in: nothing can push it out, and trying
// must not pile up forces.
TEST(Fuzz, LockedWedge)
{
  const double a = 20. * M_PI / 180., mu = 0.9;
  for (const double restitution : {0., 0.9})
    for (const double speed : {0., -0.5})
      {
        Scene s;
        s.stepper.settings().wall_friction = mu;
        s.stepper.settings().restitution   = restitution;
        s.stepper.set_walls({{{{-20. * d * std::sin(a), 20. * d * std::cos(a)}}, {{0., 0.}}, {{0., 0.}}, "left"},
                             {{{0., 0.}}, {{20. * d * std::sin(a), 20. * d * std::cos(a)}}, {{0., 0.}}, "right"}});
        s.add(0., (speed == 0. ? 0.95 : 1.05) * r / std::sin(a), 0., speed);
        const double start = s.energy();
        for (int k = 0; k < 300; ++k)
          {
            s.step(1e-4);
            const double impact = s.grains.mass[0] * std::abs(speed) / 1e-4;
            for (const auto &[name, force] : s.report.wall_force)
              ASSERT_LT(std::hypot(force[0], force[1]), 100. * (s.weight() + impact))
                << restitution << ' ' << speed << ' ' << k;
            ASSERT_LT(s.energy(), start + 0.1 * s.weight() * d);
          }
        EXPECT_GT(s.grains.position[1][0], 0.9 * r / std::sin(a));
        EXPECT_LT(std::abs(s.grains.position[0][0]), 1e-3 * d);
      }
}

// The first of three balls hits the second at the moment at which the third leaves it: no energy comes of it.
TEST(Fuzz, ImpactWhileAnotherLeaves)
{
  for (const double restitution : {0.5, 0.9, 1.})
    {
      Scene s;
      s.exact();
      s.gy                             = 0.;
      s.stepper.settings().restitution = restitution;
      s.add(0., 0., 2.);
      s.add(d, 0., 0.);
      s.add(2. * d, 0., 0.5);
      const double before = s.kinetic_energy(), momentum = 2.5;
      s.step(2e-5);
      EXPECT_LE(s.kinetic_energy(), before * (1. + 1e-9)) << restitution;
      EXPECT_NEAR(s.grains.velocity[0][0] + s.grains.velocity[0][1] + s.grains.velocity[0][2], momentum, 1e-10);
    }
}

// Overlaps open without gravity too, when everything else is at rest.
TEST(Fuzz, OverlapsOpenWithoutGravity)
{
  Scene s;
  s.gy = 0.;
  s.add(0., 0.);
  s.add(0.95 * d, 0.);
  s.step(1e-3, 300);
  EXPECT_LT(s.report.max_penetration, 1e-3 * d);
  EXPECT_LT(s.report.max_velocity, 1e-2 * d / 1e-3);
}
