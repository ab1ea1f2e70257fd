// What grains do with the moment correction and without: slopes, a collapse, a silo, a drum. Flows of grains are
// chaotic: a third run, that solves contacts in another order, shows how far apart two runs of the same scene are
// anyway. contrib/validate moments prints the tables.
#include "../contacts/silo.h"

#include <alluvium/deposits/deposit.h>
#include <alluvium/utilities/plugin.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::contacts::test;

namespace
{
  struct Mode
  {
    const char *name;
    bool        corrects;
    double      skin;
  };
  constexpr Mode modes[] = {{"without", false, 0.15}, {"without, other order", false, 0.2}, {"with", true, 0.15}};

  const double dt = 0.1 * std::sqrt(d / g); // 1e-3 s

  void configure(ContactSettings &settings, const Mode &mode)
  {
    settings.moment_correction = mode.corrects;
    settings.skin              = mode.skin;
    settings.rest_steps        = 0;
    settings.rolling_friction  = 0.1; // or single discs roll for ever
  }

  /** A settled bed between x = 0 and @p width, with side walls or periodic. */
  void add_bed(Scene &scene, const double width, const unsigned int n, const bool periodic)
  {
    deposits::DepositContext context;
    context.lower   = {{0., 0.}};
    context.upper   = {{width, 400. * d}};
    context.density = density;
    context.gravity = {{0., -g}};
    if (periodic)
      context.periodicity.length[0] = width;
    auto                     deposit = Registry<deposits::Deposit>::entries().at("settled bed").create();
    dealii::ParameterHandler prm;
    deposit->add_parameters(prm);
    prm.parse_input_from_string("set Number of grains = " + std::to_string(n) +
                                "\nset Smallest diameter = 0.9e-3\nset Size ratio = 1.2\nset Cache folder =\n");
    for (const deposits::NewGrain &s : deposit->make(context))
      scene.add(s.x, s.y, 0., 0., s.radius);
  }

  /** Root mean square and largest way of the grains since they were at @p x, @p y, over d. */
  std::array<double, 2> way(const Scene &scene, const GrainArrays &before)
  {
    double sum = 0., largest = 0.;
    for (std::size_t k = 0; k < scene.grains.n(); ++k)
      {
        // x0, y0 go along with what crosses the periodic boundary
        const double x = (scene.grains.position[0][k] - scene.grains.initial_position[0][k]) -
                         (before.position[0][k] - before.initial_position[0][k]),
                     y = (scene.grains.position[1][k] - scene.grains.initial_position[1][k]) -
                         (before.position[1][k] - before.initial_position[1][k]);
        sum += x * x + y * y;
        largest = std::max(largest, std::hypot(x, y));
      }
    return {{std::sqrt(sum / scene.grains.n()) / d, largest / d}};
  }

  double to_radians(const double degrees)
  {
    return degrees * M_PI / 180.;
  }

  /** Take steps; how often moments were corrected. */
  unsigned int corrections_in(Scene &scene, const int n_steps)
  {
    unsigned int n = 0;
    for (int s = 0; s < n_steps; ++s)
      {
        scene.step(dt);
        n += scene.report.n_corrections;
      }
    return n;
  }

  /** A periodic layer on a floor that is tilted by and by. */
  struct Slope
  {
    Scene  scene;
    double angle = 0.; // [degrees]

    explicit Slope(const Mode &mode)
    {
      const double width = 60. * d;
      add_bed(scene, width, 1500, true);
      configure(scene.stepper.settings(), mode);
      scene.stepper.settings().wall_friction = 1.; // it is the bed that yields
      Periodicity periodicity;
      periodicity.length[0] = width;
      scene.stepper.set_periodicity(periodicity);
      scene.stepper.set_walls({{{{0., 0.}}, {{width, 0.}}, {{0., 0.}}, "floor"}});
      scene.step(dt, 50);
    }

    /** Up to @p end, in 0.25 degrees every 40 steps; ends where in these the grains move by 0.1 d. */
    bool tilt_to(const double end)
    {
      while (angle < end)
        {
          angle += 0.25;
          scene.incline(to_radians(angle));
          const GrainArrays before = scene.grains;
          scene.step(dt, 40);
          if (way(scene, before)[0] > 0.1)
            return false;
        }
      return true;
    }
  };
} // namespace

TEST(MomentsTable, Slope)
{
  std::printf("\n| moments are corrected | flows at [degrees] | 1 degree below, in 0.5 s: way / d, rms | largest | "
              "corrections | 4 degrees above: mean speed from 0.3 to 0.6 s / sqrt(g d) |\n|---|---|---|---|---|---|\n");
  double flows[3], speed[3];
  for (unsigned int m = 0; m < 3; ++m)
    {
      Slope steep(modes[m]);
      EXPECT_FALSE(steep.tilt_to(45.));
      flows[m] = steep.angle;

      Slope below(modes[m]);
      EXPECT_TRUE(below.tilt_to(flows[m] - 1.));
      const GrainArrays  before        = below.scene.grains;
      const unsigned int n_corrections = corrections_in(below.scene, 500);
      const auto         moved         = way(below.scene, before);
      EXPECT_LT(moved[0], 0.05);
      EXPECT_EQ(n_corrections > 0, modes[m].corrects);

      // all at once, so that it is one flow for all
      Slope above(modes[m]);
      above.scene.incline(to_radians(flows[0] + 4.));
      above.scene.step(dt, 300);
      const GrainArrays then = above.scene.grains;
      above.scene.step(dt, 300);
      speed[m] = 0.;
      for (std::size_t k = 0; k < then.n(); ++k)
        speed[m] += (above.scene.grains.position[0][k] - above.scene.grains.initial_position[0][k] -
                     then.position[0][k] + then.initial_position[0][k]) /
                    (then.n() * 300. * dt * std::sqrt(g * d));
      std::printf("| %s | %.2f | %.1e | %.1e | %u | %.3f |\n",
                  modes[m].name,
                  flows[m],
                  moved[0],
                  moved[1],
                  n_corrections,
                  speed[m]);
    }
  EXPECT_NEAR(flows[2], flows[0], 0.51);
  EXPECT_NEAR(speed[2] / speed[0], 1., 0.1);
}

// A column whose side wall is taken away: an avalanche, then a pile.
TEST(MomentsTable, Collapse)
{
  std::printf("\n| moments are corrected | 9 of 10 grains within [d] | height [d] | mean height [d] | pile, in 0.5 "
              "s: way / d, rms | largest | corrections |\n|---|---|---|---|---|---|---|\n");
  double reach[3], mean[3];
  for (unsigned int m = 0; m < 3; ++m)
    {
      Scene        scene;
      const double width = 40. * d;
      add_bed(scene, width, 1600, false);
      configure(scene.stepper.settings(), modes[m]);
      const WallSegment left  = {{{0., 1.}}, {{0., 0.}}, {{0., 0.}}, "left"},
                        floor = {{{0., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"};
      scene.stepper.set_walls({left, floor, {{{width, 0.}}, {{width, 1.}}, {{0., 0.}}, "right"}});
      scene.step(dt, 50);
      scene.stepper.set_walls({left, floor});
      scene.step(dt, 1000);
      const GrainArrays   before        = scene.grains;
      const unsigned int  n_corrections = corrections_in(scene, 500);
      const auto          moved         = way(scene, before);
      std::vector<double> x             = scene.grains.position[0];
      std::sort(x.begin(), x.end());
      reach[m]      = x[x.size() * 9 / 10] / d;
      double height = 0.;
      mean[m]       = 0.;
      for (const double y : scene.grains.position[1])
        {
          height = std::max(height, y / d);
          mean[m] += y / d / scene.grains.n();
        }
      std::printf("| %s | %.1f | %.1f | %.2f | %.1e | %.1e | %u |\n",
                  modes[m].name,
                  reach[m],
                  height,
                  mean[m],
                  moved[0],
                  moved[1],
                  n_corrections);
    }
  EXPECT_NEAR(reach[2] / reach[0], 1., 0.05);
  EXPECT_NEAR(mean[2] / mean[0], 1., 0.03);
}

// The floor sinks so slowly that the grains count as at rest.
TEST(MomentsTable, Silo)
{
  std::printf("\n| moments are corrected | rows | floor force / weight | over Janssen's | wall friction used | wall "
              "pressure / stress | corrections |\n|---|---|---|---|---|---|---|\n");
  for (const int n_rows : {160, 240})
    {
      double floor[3];
      for (unsigned int m = 0; m < 3; ++m)
        {
          const int    n_columns = 8;
          const Silo   silo      = fill_silo(n_columns, n_rows, 0.01 * g * dt, 0.1 * d, [&](ContactSettings &s) {
            configure(s, modes[m]);
            s.rolling_friction = 0.;
          });
          const double width = (n_columns + 0.5) * 1.05 * d, length = width / (2. * 0.3 * silo.mobilised * silo.ratio);
          const double janssen = silo.packing_weight * length * (1. - std::exp(-silo.height / length)) * width;
          floor[m]             = silo.floor / silo.weight;
          std::printf("| %s | %d | %.4f | %.3f | %.3f | %.3f | %u |\n",
                      modes[m].name,
                      n_rows,
                      floor[m],
                      silo.floor / janssen,
                      silo.mobilised,
                      silo.ratio,
                      silo.n_corrections);
          EXPECT_NEAR(silo.floor / janssen, 1., 0.6); // friction is far from fully used
        }
      EXPECT_NEAR(floor[2] / floor[0], 1., 0.2);
    }
}

namespace
{
  /** A drum of radius 30 d, half full. */
  void fill_drum(Scene &scene, const double spin)
  {
    const double             radius = 30. * d;
    constexpr int            n      = 60;
    std::vector<WallSegment> walls;
    for (int k = 0; k < n; ++k)
      {
        const auto corner = [&](const int j) -> std::array<double, 2> {
          const double a = 2. * M_PI * (j % n) / n;
          return {{radius * std::cos(a), radius * std::sin(a)}};
        };
        walls.push_back({corner(k), corner(k + 1), {{0., 0.}}, "drum", spin, {{0., 0.}}});
      }
    scene.stepper.set_walls(walls);
    scene.stepper.settings().wall_friction = 1.;
    RandomNumbers random(7);
    for (int row = 0; row < 34; ++row)
      for (int column = 0; column < 60; ++column)
        {
          const double x = (column - 29.5 + 0.5 * (row % 2)) * 1.02 * d, y = -28.6 * d + row * 0.92 * d;
          if (std::hypot(x, y) < radius - 0.6 * d)
            scene.add(x, y, 0., 0., r * random.uniform(0.85, 1.));
        }
  }

  /** How far the grains are turned out of the direction of gravity, as seen from the axis [degrees]. */
  double lean(const Scene &scene)
  {
    double x = 0., y = 0.;
    for (std::size_t k = 0; k < scene.grains.n(); ++k)
      {
        x += scene.grains.mass[k] * scene.grains.position[0][k];
        y += scene.grains.mass[k] * scene.grains.position[1][k];
      }
    return std::atan2(x * scene.gy - y * scene.gx, x * scene.gx + y * scene.gy) * 180. / M_PI;
  }
} // namespace

// In a drum that turns nothing is at rest: the correction has nothing to say, to the bit.
TEST(MomentsTable, DrumTurns)
{
  std::vector<double> x[2];
  for (const bool corrects : {false, true})
    {
      Scene scene;
      configure(scene.stepper.settings(), {"", corrects, 0.15});
      fill_drum(scene, 1.);
      ASSERT_GT(scene.grains.n(), 1000u);
      EXPECT_EQ(corrections_in(scene, 1500), 0u);
      x[corrects] = scene.grains.position[0];
      EXPECT_GT(std::abs(lean(scene)), 10.);
    }
  EXPECT_EQ(x[0], x[1]);
}

// Seen from a drum that turns slowly it is gravity that turns: the bed stands until an avalanche goes down.
TEST(MomentsTable, Drum)
{
  std::printf("\n| moments are corrected | lean of the grains [degrees]: mean | standard deviation | largest | "
              "avalanches | corrections |\n|---|---|---|---|---|---|\n");
  double means[3];
  for (unsigned int m = 0; m < 3; ++m)
    {
      Scene scene;
      configure(scene.stepper.settings(), modes[m]);
      fill_drum(scene, 0.);
      scene.step(dt, 600);
      constexpr int    n_steps = 10000;
      constexpr double speed   = 20.; // [degrees/s]
      double           sum = 0., square = 0., largest = 0., top = 0.;
      int              n = 0, n_avalanches = 0;
      unsigned int     n_corrections = 0;
      for (int s = 0; s < n_steps; ++s)
        {
          const double a = to_radians(speed * s * dt);
          scene.gx       = g * std::sin(a);
          scene.gy       = -g * std::cos(a);
          scene.step(dt);
          n_corrections += scene.report.n_corrections;
          const double now = std::abs(lean(scene));
          // an avalanche: down by a degree from the highest since the last
          if (now < top - 1.)
            {
              ++n_avalanches;
              top = now;
            }
          top = n_avalanches > 0 && now < top ? now : std::max(top, now);
          if (speed * s * dt > 45.)
            {
              ++n;
              sum += now;
              square += now * now;
              largest = std::max(largest, now);
            }
        }
      means[m] = sum / n;
      std::printf("| %s | %.2f | %.2f | %.2f | %d | %u |\n",
                  modes[m].name,
                  means[m],
                  std::sqrt(square / n - means[m] * means[m]),
                  largest,
                  n_avalanches,
                  n_corrections);
    }
  EXPECT_NEAR(means[2], means[0], 2.); // of one avalanche each
}
