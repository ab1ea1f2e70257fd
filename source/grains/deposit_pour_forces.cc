#include <alluvium/grains/deposit_pour_forces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace alluvium::grains
{
  namespace
  {
    /** Unit vector from a disc to what it lies on. */
    std::array<double, 2> normal_to(const std::vector<Seed> &seeds, const std::size_t disc, const int support)
    {
      switch (support)
        {
          case Pour::floor:
            return {{0., -1.}};
          case Pour::left:
            return {{-1., 0.}};
          case Pour::right:
            return {{1., 0.}};
          default:
            const double dx = seeds[support].x - seeds[disc].x, dy = seeds[support].y - seeds[disc].y,
                         distance = std::sqrt(dx * dx + dy * dy);
            return {{dx / distance, dy / distance}};
        }
    }
  } // namespace

  std::vector<SupportForce> find_support_forces(const std::vector<Seed>        &seeds,
                                                const std::vector<Pour::Place> &places,
                                                const double                    g,
                                                const double                    mu)
  {
    struct Load
    {
      double x = 0., y = 0., tangential = 0.; // the last: sum of the tangential forces from above, the moment over -r
    };
    std::vector<Load>         loads(seeds.size());
    std::vector<SupportForce> forces;
    forces.reserve(2 * seeds.size());
    const auto give = [&](const std::size_t            disc,
                          const int                    support,
                          const std::array<double, 2> &n,
                          double                       normal,
                          double                       tangential) {
      normal     = std::max(normal, 0.);
      tangential = std::clamp(tangential, -mu * normal, mu * normal);
      forces.push_back({disc, support, normal, tangential});
      if (support >= 0)
        {
          loads[support].x += normal * n[0] - tangential * n[1];
          loads[support].y += normal * n[1] + tangential * n[0];
          loads[support].tangential += tangential;
        }
    };

    for (std::size_t k = seeds.size(); k-- > 0;)
      {
        const Load   &load = loads[k];
        const double  x = load.x, y = load.y - seeds[k].density * M_PI * seeds[k].radius * seeds[k].radius * g;
        const auto   &supports = places[k].supports;
        const auto    n        = normal_to(seeds, k, supports[0]);
        if (supports[1] == Pour::nothing)
          {
            give(k, supports[0], n, x * n[0] + y * n[1], y * n[0] - x * n[1]);
            continue;
          }
        const auto   m   = normal_to(seeds, k, supports[1]);
        const double det = n[0] * m[1] - n[1] * m[0];
        if (std::abs(det) < 1e-6) // opposite each other: they can only squeeze the disc
          {
            give(k, supports[0], n, x * n[0] + y * n[1], y * n[0] - x * n[1]);
            continue;
          }
        // Tangential forces -B/2 + c and -B/2 - c keep the moment; the normal ones are then a + b c each.
        const double half = -0.5 * load.tangential;
        const auto   normal_forces = [&](const double c) {
          const double t1 = half + c, t2 = half - c;
          const double rx = x + t1 * n[1] + t2 * m[1], ry = y - t1 * n[0] - t2 * m[0];
          return std::array<double, 2>{{(rx * m[1] - ry * m[0]) / det, (ry * n[0] - rx * n[1]) / det}};
        };
        const auto   at_0 = normal_forces(0.), at_1 = normal_forces(1.);
        double       low = -std::numeric_limits<double>::infinity(), high = -low;
        for (int s = 0; s < 2; ++s)
          for (const double sign : {-1., 1.})
            {
              // mu (a + b c) + sign (half + c') >= 0 with c' = c or -c
              const double constant = mu * at_0[s] + sign * half,
                           slope    = mu * (at_1[s] - at_0[s]) + sign * (s == 0 ? 1. : -1.);
              if (slope > 0.)
                low = std::max(low, -constant / slope);
              else if (slope < 0.)
                high = std::min(high, -constant / slope);
            }
        const double c = low <= high ? std::clamp(0., low, high) : 0.5 * (low + high);
        const auto   a = normal_forces(std::isfinite(c) ? c : 0.);
        give(k, supports[0], n, a[0], half + (std::isfinite(c) ? c : 0.));
        give(k, supports[1], m, a[1], half - (std::isfinite(c) ? c : 0.));
      }
    return forces;
  }
} // namespace alluvium::grains
