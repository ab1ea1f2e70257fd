#include <alluvium/grains/contact_solver.h>
#include <alluvium/grains/contact_sweep.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::grains
{
  /**
   * Gauss-Seidel sweeps with Nesterov momentum between them: about 3 n sweeps for a cold pile of n layers.
   *
   * The momentum starts anew when both the objective v.M v / 2 + b.r and the changes of a sweep have grown since two
   * iterations ago. The objective alone is no judge where grains slide: friction makes the problem no minimisation, and
   * near the solution the objective may have to grow. The momentum is capped when the residual stalls. After many
   * forward sweeps, iterations become symmetric (forward, backward), which deep beds need for the momentum to be
   * stable.
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
      last.clear();
      for (const Contact &c : problem.contacts)
        last.push_back({c.rn, c.rt});
      for (Disc &d : problem.discs)
        remember(d);

      double       t = 1., beta = 0., cap = 1., objective = std::numeric_limits<double>::max();
      double       last_change  = std::numeric_limits<double>::max();
      double       stall_change = std::numeric_limits<double>::max();
      unsigned int stall_start  = 0;
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
          if (change <= tolerance.allowance(solution.sweeps) * tolerance.residual)
            {
              measure_residual(measure, solution);
              if (solution.meets(tolerance))
                {
                  solution.converged = true;
                  return solution;
                }
            }

          if (solution.sweeps >= stall_start + stall_sweeps)
            {
              if (change > 0.7 * stall_change)
                cap = std::max(0.95, cap - 0.01);
              stall_change = change;
              stall_start  = solution.sweeps;
            }
          if (iteration % 2 == 1)
            {
              const double now = measure.kinetic_energy() + sums.work;
              if (now > objective && change > last_change)
                t = 1.;
              objective   = now;
              last_change = change;
            }
          const double t_next = 0.5 * (1. + std::sqrt(1. + 4. * t * t));
          beta                = std::min(cap, (t - 1.) / t_next);
          t                   = t_next;
        }
      measure_residual(measure, solution);
      return solution;
    }

  private:
    unsigned int forward_sweeps = 1000;
    unsigned int stall_sweeps   = 100;

    mutable std::vector<LastImpulse> last; // kept to save the allocation

    static void remember(Disc &d)
    {
      d.last_x = d.x;
      d.last_y = d.y;
      d.last_s = d.s;
    }

    static void extrapolate(ContactProblem &problem, const double beta)
    {
      for (std::size_t k = 0; k < problem.n_discs; ++k)
        {
          Disc      &d   = problem.discs[k];
          const Disc now = d;
          d.x += beta * (now.x - now.last_x);
          d.y += beta * (now.y - now.last_y);
          d.s += beta * (now.s - now.last_s);
          d.last_x = now.x;
          d.last_y = now.y;
          d.last_s = now.s;
        }
    }
  };

  ALLUVIUM_REGISTER(ContactSolver,
                    AcceleratedGaussSeidel,
                    "accelerated Gauss-Seidel",
                    "Gauss-Seidel sweeps with Nesterov momentum: about 3 n sweeps on a cold bed of n layers.")
} // namespace alluvium::grains
