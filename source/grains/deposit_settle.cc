#include <alluvium/grains/contact_stepper.h>
#include <alluvium/grains/deposit_settle.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstdio>

namespace alluvium::grains
{
  std::vector<WallSegment> settling_walls(const DepositBox &box)
  {
    const double far = box.upper[1] + 1e3 * (box.width() + box.height());
    return {{box.lower, {{box.upper[0], box.lower[1]}}, {{0., 0.}}, "floor"},
            {{{box.lower[0], far}}, box.lower, {{0., 0.}}, "left"},
            {{{box.upper[0], box.lower[1]}}, {{box.upper[0], far}}, {{0., 0.}}, "right"}};
  }

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
  } // namespace

  Stillness bring_to_rest(const Settling &settling, std::vector<Seed> &seeds)
  {
    sort_into_rows(settling.box, seeds);
    GrainArrays       grains;
    GrainLoads        loads;
    const std::size_t n = seeds.size();
    grains.resize(n);
    loads.reset(n);
    double weight = 0., smallest = seeds.front().radius;
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
        smallest = std::min(smallest, s.radius);
      }
    const double   dt = 0.2 * std::sqrt(2. * smallest / settling.g);
    ContactStepper stepper;
    stepper.set_walls(settling_walls(settling.box));
    stepper.settings().friction = stepper.settings().wall_friction = settling.friction;
    constexpr unsigned int n_steps = 4000;
    Stillness              still;
    unsigned int           quiet = 0;
    bool                   thick = true;
    for (; still.n_steps < n_steps && quiet < 10; ++still.n_steps)
      {
        for (std::size_t k = 0; k < n; ++k)
          loads.drag[k] = thick ? grains.mass[k] / (2. * dt) : 0.;
        stepper.settings().residual_tolerance = thick ? 1e-5 : 1e-6;
        const ContactReport report            = stepper.advance(grains, loads, dt, {{0., -settling.g}});
        double              energy            = 0.;
        still.support                         = 0.;
        for (const auto &[name, force] : report.wall_force)
          still.support -= force[1] / weight;
        for (std::size_t k = 0; k < n; ++k)
          energy += grains.mass[k] * (grains.vx[k] * grains.vx[k] + grains.vy[k] * grains.vy[k]);
        still.speed            = std::sqrt(energy * settling.g / weight) / (settling.g * dt);
        still.mean_penetration = report.mean_penetration;
        if (std::getenv("DBG"))
          std::printf("step %u thick %d speed %g support %g sweeps %llu halv %u unc %u res %g contacts %u pen %g max %g\n", still.n_steps, thick, still.speed, still.support, report.n_sweeps, report.n_halvings, report.n_unconverged, report.residual, report.n_contacts, report.mean_penetration/smallest/2, report.max_penetration/smallest/2), fflush(stdout);
        if (thick)
          thick = still.n_steps < 200 && !(still.speed < 1e-2 && std::abs(still.support - 1.) < 1e-2);
        else
          quiet = still.speed < 1e-3 && std::abs(still.support - 1.) < 1e-4 ? quiet + 1 : 0;
      }
    check_user(quiet > 0, "The deposit 'settled bed' did not come to rest: try another seed or more friction.");
    for (std::size_t k = 0; k < n; ++k)
      {
        seeds[k].x = grains.x[k];
        seeds[k].y = grains.y[k];
      }
    return still;
  }
} // namespace alluvium::grains
