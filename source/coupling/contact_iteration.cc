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
      GrainMotion motion{displacements(after), after.omega};
      for (unsigned int d = 0; d < 2; ++d)
        for (std::size_t g = 0; g < after.n(); ++g)
          motion.velocity[d][g] = (motion.velocity[d][g] - before[d][g]) / dt;
      return motion;
    }

    /** @p result = sum of @p weights times what @p part takes from @p motions. */
    template <typename Part>
    void mix(const std::vector<GrainMotion> &motions,
             const std::vector<double>      &weights,
             const Part                     &part,
             std::vector<double>            &result)
    {
      result.assign(part(motions[0]).size(), 0.);
      for (std::size_t i = 0; i < motions.size(); ++i)
        for (std::size_t g = 0; g < result.size(); ++g)
          result[g] += weights[i] * part(motions[i])[g];
    }

    GrainMotion mix(const std::vector<GrainMotion> &motions, const std::vector<double> &weights)
    {
      GrainMotion result;
      for (unsigned int d = 0; d < 2; ++d)
        mix(
          motions, weights, [d](const GrainMotion &m) -> const auto & { return m.velocity[d]; }, result.velocity[d]);
      mix(
        motions, weights, [](const GrainMotion &m) -> const auto & { return m.omega; }, result.omega);
      return result;
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


  ContactIteration::Attempt ContactIteration::move(grains::GrainArrays         &grains,
                                                   const grains::GrainLoads    &loads,
                                                   const double                 dt,
                                                   const std::array<double, 2> &gravity,
                                                   const double                 tolerance_factor)
  {
    const auto               timer  = timers.scope("contacts");
    const grains::Components before = displacements(grains), velocity = grains.velocity;
    Attempt                  attempt;
    attempt.report = contacts.advance(grains, loads, dt, gravity, tolerance_factor);
    attempt.motion = mean_motion(before, grains, dt);
    attempt.defect = coupling.momentum_defect(grains, velocity, attempt.motion, loads);
    return attempt;
  }


  contacts::ContactReport ContactIteration::advance(grains::GrainArrays         &grains,
                                                    grains::GrainLoads          &loads,
                                                    const double                 dt,
                                                    const std::array<double, 2> &gravity)
  {
    constexpr unsigned int           depth = 5; // of the mixing
    const TimeScheme::IterationLimit limit = is_left_out ? TimeScheme::IterationLimit() : coupling.iteration_limit();
    const bool                       tries = limit.largest_number > 0;
    // the tolerance of 1e-2 bears contacts a hundred times looser, a tight one none
    const double             tolerance_factor = tries ? std::clamp(1e4 * limit.tolerance, 1., 100.) : 1.;
    contacts::StepStart      start;
    AndersonMixing           mixing(depth);
    std::vector<GrainMotion> motions;
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
        Attempt attempt = move(grains, loads, dt, gravity, tolerance_factor);
        count(attempt.report);
        const double defect = root_mean_square(attempt.defect);
        n_stalled           = defect > 0.7 * best ? n_stalled + 1 : 0;
        best                = std::min(best, defect);
        if (is_left_out)
          {
            const double typical = coupling.typical_force(grains);
            relative_defect      = typical > 0. ? defect / typical : 0.;
          }
        const double tolerance = n == 0 ? 0.1 * limit.tolerance : limit.tolerance;
        agree                  = !tries || agrees(grains, attempt, tolerance);
        if (agree || n_stalled == 2 || n == limit.largest_number)
          {
            if (attempt.report.was_loosened)
              {
                start.restore(grains, contacts);
                attempt = move(grains, loads, dt, gravity, 1.);
                count(attempt.report);
                agree = agrees(grains, attempt, tolerance); // was_loosened only if the step may be repeated
              }
            coupling.set_momentum_defect(attempt.defect);
            return attempt.report;
          }
        motions.push_back(std::move(attempt.motion));
        mixing.add(std::move(attempt.defect));
        if (motions.size() > mixing.n())
          motions.erase(motions.begin());
        const std::vector<double> weights = mixing.weights();
        const auto                timer   = timers.scope("fluid");
        start.restore(grains, contacts);
        coupling.repeat(grains, mix(motions, weights), weights, loads);
      }
  }


  bool ContactIteration::agrees(const grains::GrainArrays &grains, const Attempt &attempt, const double tolerance) const
  {
    return root_mean_square(attempt.defect) <= tolerance * coupling.typical_force(grains) &&
           size_of_sum(attempt.defect) <= 0.1 * tolerance * coupling.report().force_scale;
  }
} // namespace alluvium::coupling
