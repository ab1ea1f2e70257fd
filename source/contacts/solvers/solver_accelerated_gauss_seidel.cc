#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/contact_sweep.h>
#include <alluvium/contacts/solvers/moment_correction.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::contacts
{
  /**
   * Gauss-Seidel sweeps with Nesterov momentum between them: about 3 n sweeps for a cold pile of n layers.
   *
   * The momentum starts anew when both the objective v.M v / 2 + b.r and the changes of a sweep have grown since two
   * iterations ago. The objective alone is no judge where grains slide: friction makes the problem no minimisation, and
   * near the solution the objective may have to grow. The momentum is capped further when the residual stalls. A bed
   * that is known to be at rest is what eager restarts and caps keep from converging, so it has fewer. After many
   * forward sweeps, iterations become symmetric (forward, backward), which beds of several hundred layers need for the
   * momentum to be stable.
   */
  class AcceleratedGaussSeidel : public ContactSolver
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter(
        "Forward sweeps first",
        forward_sweeps,
        "How many forward sweeps to try before iterations become pairs of a forward and a backward sweep, "
        "which cost twice as much and converge on beds of any depth. 0: symmetric from the start.",
        dealii::Patterns::Integer(0));
      prm.add_parameter(
        "Largest momentum",
        largest_momentum,
        "The largest part of an impulse's last change that is added to it before a sweep [-]. Nearer to 1 is faster "
        "on beds of many hundred layers, less settles down more surely.",
        dealii::Patterns::Double(0., 1.));
      prm.add_parameter(
        "Stall sweeps",
        stall_sweeps,
        "The momentum is capped further whenever the residual has not dropped by 30 % in this many sweeps.",
        dealii::Patterns::Integer(1));
    }

    ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const override
    {
      ContactSolution solution;
      apply_impulses(problem);
      ContactMeasure measure(problem);
      restart(problem);

      double t = 1., beta = 0., cap = largest_momentum;
      // Where things move, momentum that overshoots finds nobody to stop it; a bed at rest needs patience.
      const double growth = tolerance.at_rest ? 1.5 : 1.;
      if (tolerance.at_rest)
        cap = std::min(cap, 1. - 1. / std::sqrt(1. + measure.n_contacts())); // 1 - 1 / number of layers, roughly
      double       stall_change = std::numeric_limits<double>::max();
      unsigned int stall_start  = 0;
      double       objective = std::numeric_limits<double>::max(), last_change = objective;
      for (unsigned int iteration = 0; solution.sweeps < tolerance.max_sweeps; ++iteration)
        {
          if (iteration > 0)
            extrapolate(problem, beta);
          SweepSums sums = sweep(problem, measure, SweepOrder::forward, last.data(), beta);
          ++solution.sweeps;
          if (solution.sweeps > forward_sweeps)
            {
              sums = sweep(problem, measure, SweepOrder::backward);
              ++solution.sweeps;
            }

          const double change = measure.relative_change(sums);
          if (is_solved(measure, sums, tolerance, solution))
            return solution;

          if (!tolerance.at_rest && solution.sweeps >= stall_start + stall_sweeps)
            {
              if (change > 0.7 * stall_change)
                cap = std::max(std::min(0.95, largest_momentum), cap - 0.01);
              stall_change = change;
              stall_start  = solution.sweeps;
            }
          if (correct_if_due(problem, solution.sweeps))
            {
              restart(problem);
              t           = 1.;
              last_change = objective = std::numeric_limits<double>::max();
            }
          else if (iteration % 2 == 1)
            {
              const double now = measure.kinetic_energy() + sums.work;
              if (now > objective && change > growth * last_change)
                t = 1.;
              objective   = now;
              last_change = change;
            }
          const double t_next = 0.5 * (1. + std::sqrt(1. + 4. * t * t));
          beta                = std::min(cap, (t - 1.) / t_next);
          t                   = t_next;
        }
      give_up(measure, tolerance, solution);
      return solution;
    }

  private:
    double       largest_momentum = 0.99;
    unsigned int forward_sweeps   = 1000;
    unsigned int stall_sweeps     = 100;

    mutable std::vector<LastImpulse> last; // kept to save the allocation

    /** Let the momentum start from the impulses and velocities as they are. */
    void restart(ContactProblem &problem) const
    {
      last.resize(problem.contacts.size());
      for (std::size_t k = 0; k < last.size(); ++k)
        last[k] = {problem.contacts[k].rn, problem.contacts[k].rt};
      remember(problem);
      for (RollingFriction &r : problem.rolling)
        r.last = r.impulse;
    }
  };

  ALLUVIUM_REGISTER(ContactSolver,
                    AcceleratedGaussSeidel,
                    "accelerated Gauss-Seidel",
                    "Gauss-Seidel sweeps with Nesterov momentum: about 3 n sweeps on a cold bed of n layers.")
} // namespace alluvium::contacts
