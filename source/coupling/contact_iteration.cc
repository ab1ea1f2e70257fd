#include <alluvium/coupling/anderson_mixing.h>
#include <alluvium/coupling/contact_iteration.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::coupling
{
  namespace
  {
    /** From displacements: sub-steps, bounces and walls of a periodic box included, the drag that grains felt. */
    GrainMotion mean_motion(const grains::GrainArrays &before, const grains::GrainArrays &after, const double dt)
    {
      GrainMotion motion{before.vx, before.vy, after.omega};
      for (std::size_t g = 0; g < before.n(); ++g)
        {
          motion.vx[g] = ((after.x[g] - after.x0[g]) - (before.x[g] - before.x0[g])) / dt;
          motion.vy[g] = ((after.y[g] - after.y0[g]) - (before.y[g] - before.y0[g])) / dt;
        }
      return motion;
    }

    void mix(const std::vector<GrainMotion> &motions, const std::vector<double> &weights, GrainMotion &result)
    {
      for (auto part : {&GrainMotion::vx, &GrainMotion::vy, &GrainMotion::omega})
        {
          std::vector<double> &sum = result.*part;
          sum.assign((motions[0].*part).size(), 0.);
          for (std::size_t i = 0; i < motions.size(); ++i)
            for (std::size_t g = 0; g < sum.size(); ++g)
              sum[g] += weights[i] * (motions[i].*part)[g];
        }
    }

    double root_mean_square(const std::vector<double> &components)
    {
      double sum = 0.;
      for (const double x : components)
        sum += x * x;
      return std::sqrt(2. * sum / components.size());
    }
  } // namespace


  grains::ContactReport ContactIteration::advance(grains::GrainArrays         &grains,
                                                  grains::GrainLoads          &loads,
                                                  const double                 dt,
                                                  const std::array<double, 2> &gravity)
  {
    constexpr unsigned int       depth = 5; // of the mixing
    const TimeScheme::Repetition limit = coupling.repetition();
    grains::ContactMemory        start;
    AndersonMixing               mixing(depth);
    std::vector<GrainMotion>     motions;
    GrainMotion                  guess;
    double                       best      = std::numeric_limits<double>::max();
    unsigned int                 n_stalled = 0;
    if (limit.largest_number > 0)
      start = contacts.memory();
    for (n = 0;; ++n)
      {
        grains::GrainArrays   trial = grains;
        grains::ContactReport report;
        {
          const auto timer = timers.scope("contacts");
          report           = contacts.advance(trial, loads, dt, gravity);
        }
        motions.push_back(mean_motion(grains, trial, dt));
        std::vector<double> unseen = coupling.unseen_force(motions.back(), loads);
        const double        defect = root_mean_square(unseen);
        agree                      = limit.largest_number == 0 || defect <= limit.tolerance * coupling.typical_force();
        n_stalled                  = defect > 0.7 * best ? n_stalled + 1 : 0;
        best                       = std::min(best, defect);
        if (agree || n_stalled == 2 || n == limit.largest_number)
          {
            coupling.set_unseen_force(unseen);
            grains = std::move(trial);
            return report;
          }
        mixing.add(std::move(unseen));
        if (motions.size() > mixing.n())
          motions.erase(motions.begin());
        const std::vector<double> weights = mixing.weights();
        mix(motions, weights, guess);
        const auto timer = timers.scope("fluid");
        coupling.repeat(guess, weights, loads);
        contacts.restore(start);
      }
  }
} // namespace alluvium::coupling
