#include <alluvium/grains/contact_stepper.h>
#include <alluvium/grains/deposit_settle.h>
#include <alluvium/grains/packing.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  namespace
  {
    /** Neighbours in space become neighbours in memory: rows of about one diameter, from left to right. */
    void sort_into_rows(const DepositBox &box, std::vector<Seed> &seeds)
    {
      double row = 0.;
      for (const Seed &s : seeds)
        row = std::max(row, 2. * s.radius);
      std::sort(seeds.begin(), seeds.end(), [&](const Seed &a, const Seed &b) {
        const double ra = std::floor((a.y - box.lower[1]) / row), rb = std::floor((b.y - box.lower[1]) / row);
        return ra != rb ? ra < rb : a.x != b.x ? a.x < b.x : a.y < b.y;
      });
    }

    std::vector<WallSegment> floor_and_sides(const DepositBox &box)
    {
      const double far = box.upper[1] + 1e3 * (box.width() + box.height());
      return {{box.lower, {{box.upper[0], box.lower[1]}}, {{0., 0.}}, "floor"},
              {{{box.lower[0], far}}, box.lower, {{0., 0.}}, "left"},
              {{{box.upper[0], box.lower[1]}}, {{box.upper[0], far}}, {{0., 0.}}, "right"}};
    }
  } // namespace


  SettledState bring_to_rest(const Settling &settling, std::vector<Seed> &seeds)
  {
    sort_into_rows(settling.box, seeds);
    GrainArrays       grains;
    GrainLoads        loads;
    const std::size_t n = seeds.size();
    grains.resize(n);
    loads.reset(n);
    double weight = 0., smallest = 2. * seeds.front().radius, height = 0.;
    for (std::size_t k = 0; k < n; ++k)
      {
        const Seed &s    = seeds[k];
        grains.id[k]     = static_cast<GrainId>(k);
        grains.x[k]      = s.x;
        grains.y[k]      = s.y;
        grains.radius[k] = s.radius;
        grains.mass[k]   = s.density * M_PI * s.radius * s.radius;
        loads.fy[k]      = -grains.mass[k] * settling.g;
        weight -= loads.fy[k];
        smallest = std::min(smallest, 2. * s.radius);
        height   = std::max(height, s.y - settling.box.lower[1]);
      }
    ContactStepper stepper;
    stepper.set_walls(floor_and_sides(settling.box));
    stepper.settings().friction = stepper.settings().wall_friction = settling.friction;
    // With more, the floor of a cold bed of 300 layers carries too little at first, and all of it falls.
    stepper.settings().residual_tolerance = 1e-6;
    stepper.settings().rest_steps         = 0; // what is still is judged here

    // Contacts at rest open and close a little from step to step, so stillness is judged by means over some steps. The
    // fluid of the first stage lets a grain sink by g 2 dt^2 a step.
    constexpr unsigned int n_window = 20, n_steps = 4000;
    const double           dt      = 0.2 * std::sqrt(smallest / settling.g);
    const auto             n_thick = static_cast<unsigned int>(200. + 5. * height / smallest);
    SettledState           state;
    bool                   thick = true, still = false;
    std::vector<double>    x, y;
    unsigned int           in_window = 0;
    for (; state.n_steps < n_thick + n_steps && !still; ++state.n_steps)
      {
        for (std::size_t k = 0; k < n; ++k)
          loads.drag[k] = thick ? grains.mass[k] / (2. * dt) : 0.;
        if (in_window == 0)
          {
            x             = grains.x;
            y             = grains.y;
            state.support = 0.;
          }
        const ContactReport report = stepper.advance(grains, loads, dt, {{0., -settling.g}});
        state.mean_penetration     = report.mean_penetration;
        for (const auto &[name, force] : report.wall_force)
          state.support -= force[1] / weight / n_window;
        if (++in_window < n_window)
          continue;
        double square = 0.;
        for (std::size_t k = 0; k < n; ++k)
          square += std::pow(grains.x[k] - x[k], 2) + std::pow(grains.y[k] - y[k], 2);
        state.speed        = std::sqrt(square / n) / (n_window * dt);
        const double scale = settling.g * dt, off = std::abs(state.support - 1.);
        if (thick)
          thick = state.n_steps < n_thick && !(state.speed < 1e-2 * scale && off < 1e-2);
        else
          still = state.speed < 1e-3 * scale && off < 1e-4;
        in_window = 0;
      }
    check_user(still,
               "The deposit 'settled bed' did not come to rest in " + std::to_string(state.n_steps) +
                 " steps: its grains still move at " + std::to_string(state.speed) +
                 " m/s, and floor and sides carry " + std::to_string(state.support) +
                 " of the weight. Try another seed, or other friction while settling.");
    for (std::size_t k = 0; k < n; ++k)
      {
        seeds[k].x = grains.x[k];
        seeds[k].y = grains.y[k];
      }
    state.packing = inner_packing_fraction(grains);
    return state;
  }
} // namespace alluvium::grains
