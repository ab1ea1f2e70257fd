// A silo whose floor sinks, for Janssen's law.
#pragma once

#include "contact_scene.h"

#include <alluvium/utilities/random_numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace alluvium::contacts::test
{
  /** What the walls of a silo carry, layer by layer, while its floor gives way. */
  struct Silo
  {
    unsigned int        n_corrections = 0; // of moments, in that time
    double              height = 0., weight = 0., floor = 0., mobilised = 0., ratio = 0., packing_weight = 0.;
    std::vector<double> vertical; // mean vertical stress at the middle of each layer, from the top [N/m^2]
  };

  /**
   * Discs in a silo, filled to about @p n_rows rows, whose floor sinks slowly, at @p sinking [m/s], so that the discs
   * slip down along the walls and friction is fully used. Means over the time in which the floor sinks by @p way [m].
   * configure(settings) changes how contacts are solved.
   */
  template <class Configure>
  Silo
  fill_silo(const int n_columns, const int n_rows, const double sinking, const double way, const Configure &configure)
  {
    const double     width = (n_columns + 0.5) * 1.05 * d, top = 2. * n_rows * d;
    constexpr int    layers = 6;
    constexpr double mu     = 0.3;
    Scene            s;
    s.stepper.settings().friction      = 0.5;
    s.stepper.settings().wall_friction = mu;
    configure(s.stepper.settings());
    alluvium::RandomNumbers random(n_rows);
    for (int row = 0; row < n_rows; ++row)
      for (int column = 0; column < n_columns; ++column)
        s.add((column + 0.5 + 0.5 * (row % 2)) * 1.05 * d, r + row * 0.92 * d, 0., 0., r * random.uniform(0.7, 1.));

    // Side walls in pieces, to see the force on each.
    const auto set_walls = [&](const double bottom, const double filled, const double sinking) {
      std::vector<WallSegment> walls{{{{0., bottom}}, {{width, bottom}}, {{0., -sinking}}, "floor"}};
      for (int k = 0; k <= layers; ++k)
        for (int side = 0; side < 2; ++side)
          {
            const double x = side * width, low = k == 0 ? bottom - 5. * d : bottom + k * filled / layers,
                         high = k == layers ? top : bottom + (k + 1) * filled / layers;
            walls.push_back(
              {{{x, low}}, {{x, high}}, {{0., 0.}}, (side == 0 ? "left " : "right ") + std::to_string(k)});
          }
      s.stepper.set_walls(walls);
    };
    const auto filled = [&] {
      double y = 0.;
      for (std::size_t k = 0; k < s.grains.n(); ++k)
        y = std::max(y, s.grains.position[1][k] + s.grains.radius[k]);
      return y;
    };
    set_walls(0., filled(), 0.);
    const double dt = 0.1 * std::sqrt(d / g);
    for (int k = 0; k < 300; ++k)
      {
        s.loads.drag.resize(s.grains.n());
        for (std::size_t i = 0; i < s.grains.n(); ++i)
          s.loads.drag[i] = k < 250 ? 0.2 * s.grains.mass[i] / dt : 0.;
        s.step(dt);
      }

    Silo silo;
    silo.height = filled();
    silo.weight = s.weight();
    set_walls(0., silo.height, sinking);
    std::vector<std::array<double, 2>> wall(layers + 1, {{0., 0.}}); // normal and vertical force of both sides
    const int                          run_up  = static_cast<int>(way / (sinking * dt));
    const int                          measure = run_up;
    for (int k = 0; k < run_up + measure; ++k)
      {
        s.step(dt);
        if (k < run_up)
          continue;
        silo.floor -= s.report.wall_force["floor"][1] / measure;
        for (int l = 0; l <= layers; ++l)
          {
            const auto left  = s.report.wall_force["left " + std::to_string(l)],
                       right = s.report.wall_force["right " + std::to_string(l)];
            wall[l][0] += (right[0] - left[0]) / measure;
            wall[l][1] -= (left[1] + right[1]) / measure;
          }
        silo.n_corrections += s.report.n_corrections;
      }
    double normal = 0., vertical = 0.;
    for (const auto &w : wall)
      {
        normal += w[0];
        vertical += w[1];
      }
    silo.mobilised = vertical / (mu * normal);

    // Vertical stress from above: weight less what the walls took; then the ratio of wall pressure to it.
    double       stress_sum = 0., pressure_sum = 0., carried = 0.;
    const double layer = silo.height / layers;
    for (int l = layers; l >= 0; --l)
      {
        double above = 0.;
        for (std::size_t k = 0; k < s.grains.n(); ++k)
          if (s.grains.position[1][k] > (l + 0.5) * layer)
            above += s.grains.mass[k] * g;
        if (l < layers)
          {
            const double stress = (above - carried - 0.5 * wall[l][1]) / width;
            silo.vertical.push_back(stress);
            stress_sum += stress;
            pressure_sum += 0.5 * wall[l][0] / layer;
          }
        carried += wall[l][1];
      }
    silo.ratio          = pressure_sum / stress_sum;
    silo.packing_weight = silo.weight / (width * silo.height); // bulk weight [N/m^3]
    return silo;
  }

  inline Silo fill_silo(const int n_columns, const int n_rows)
  {
    return fill_silo(n_columns, n_rows, 5e-3 * std::sqrt(g * d), 0.5 * d, [](ContactSettings &) {});
  }
} // namespace alluvium::contacts::test
