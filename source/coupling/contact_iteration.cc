#include <alluvium/contacts/step_start.h>
#include <alluvium/coupling/contact_iteration.h>
#include <alluvium/utilities/anderson_mixing.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::coupling
{
  namespace
  {
    /** Of all grains, since t = 0: sub-steps, bounces and walls of a periodic box included [m]. */
    grains::Components displacements(const grains::GrainArrays &grains)
    {
      grains::Components result;
      for (unsigned int d = 0; d < 2; ++d)
        {
          result[d].resize(grains.n());
          for (std::size_t g = 0; g < grains.n(); ++g)
            result[d][g] = grains.position[d][g] - grains.initial_position[d][g];
        }
      return result;
    }

    /** Mean over a step of @p dt, from displacements before and after it: the motion whose drag grains felt. */
    GrainMotion mean_motion(const grains::Components &before, const grains::GrainArrays &after, const double dt)
    {
      const grains::Components moved = displacements(after);
      GrainMotion              motion{moved[0], moved[1], after.omega};
      for (std::size_t g = 0; g < after.n(); ++g)
        {
          motion.vx[g] = (moved[0][g] - before[0][g]) / dt;
          motion.vy[g] = (moved[1][g] - before[1][g]) / dt;
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
      return components.empty() ? 0. : std::sqrt(2. * sum / components.size());
    }

    double size_of_sum(const std::vector<double> &components)
    {
      std::array<double, 2> sum = {{0., 0.}};
      for (std::size_t i = 0; i < components.size(); ++i)
        sum[i % 2] += components[i];
      return std::hypot(sum[0], sum[1]);
    }
  } // namespace


  ContactIteration::Answer ContactIteration::move(grains::GrainArrays         &grains,
                                                  const grains::GrainLoads    &loads,
                                                  const double                 dt,
                                                  const std::array<double, 2> &gravity,
                                                  const double                 haste)
  {
    const auto               timer  = timers.scope("contacts");
    const grains::Components before = displacements(grains), velocity = grains.velocity;
    Answer                   answer;
    answer.report = contacts.advance(grains, loads, dt, gravity, haste);
    answer.motion = mean_motion(before, grains, dt);
    answer.unseen = coupling.unseen_force(velocity, answer.motion, loads);
    return answer;
  }


  contacts::ContactReport ContactIteration::advance(grains::GrainArrays         &grains,
                                                    grains::GrainLoads          &loads,
                                                    const double                 dt,
                                                    const std::array<double, 2> &gravity)
  {
    constexpr unsigned int       depth = 5; // of the mixing
    const TimeScheme::Repetition limit = coupling.repetition();
    const bool                   tries = limit.largest_number > 0;
    // the tolerance of 1e-2 bears contacts a hundred times looser, a tight one none
    const double             haste = tries ? std::clamp(1e4 * limit.tolerance, 1., 100.) : 1.;
    contacts::StepStart      start;
    AndersonMixing           mixing(depth);
    std::vector<GrainMotion> motions;
    GrainMotion              guess;
    double                   best      = std::numeric_limits<double>::max();
    unsigned int             n_stalled = 0;
    if (tries)
      start.remember(grains, contacts);
    contacts::ContactReport tried; // what it has cost
    const auto              count = [&](contacts::ContactReport &report) {
      tried.n_sweeps      = report.n_sweeps += tried.n_sweeps;
      tried.n_updates     = report.n_updates += tried.n_updates;
      tried.n_corrections = report.n_corrections += tried.n_corrections;
    };
    for (n = 0;; ++n)
      {
        Answer answer = move(grains, loads, dt, gravity, haste);
        count(answer.report);
        const double defect    = root_mean_square(answer.unseen);
        n_stalled              = defect > 0.7 * best ? n_stalled + 1 : 0;
        best                   = std::min(best, defect);
        const double tolerance = n == 0 ? 0.1 * limit.tolerance : limit.tolerance;
        agree                  = !tries || agrees(answer, tolerance);
        if (agree || n_stalled == 2 || n == limit.largest_number)
          {
            if (answer.report.hasty)
              {
                start.restore(grains, contacts);
                answer = move(grains, loads, dt, gravity, 1.);
                count(answer.report);
                agree = agrees(answer, tolerance); // hasty only if the step may be repeated
              }
            coupling.set_unseen_force(answer.unseen);
            return answer.report;
          }
        motions.push_back(std::move(answer.motion));
        mixing.add(std::move(answer.unseen));
        if (motions.size() > mixing.n())
          motions.erase(motions.begin());
        const std::vector<double> weights = mixing.weights();
        mix(motions, weights, guess);
        const auto timer = timers.scope("fluid");
        start.restore(grains, contacts);
        coupling.repeat(guess, weights, loads);
      }
  }


  bool ContactIteration::agrees(const Answer &answer, const double tolerance) const
  {
    return root_mean_square(answer.unseen) <= tolerance * coupling.typical_force() &&
           size_of_sum(answer.unseen) <= 0.1 * tolerance * coupling.report().force_scale;
  }
} // namespace alluvium::coupling
