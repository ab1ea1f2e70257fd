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
      ContactSolution   solution;
      const std::size_t n_discs = problem.mass.size();
      apply_impulses(problem);
      last.assign(problem.velocity.begin(), problem.velocity.begin() + n_discs);
      for (Contact &c : problem.contacts)
        {
          c.last_rn = c.rn;
          c.last_rt = c.rt;
        }

      double       t = 1., beta = 0., cap = 1., objective = std::numeric_limits<double>::max();
      double       last_change  = std::numeric_limits<double>::max();
      double       stall_change = std::numeric_limits<double>::max();
      unsigned int stall_start  = 0;
      for (unsigned int iteration = 0; solution.sweeps < tolerance.max_sweeps; ++iteration)
        {
          if (iteration > 0)
            extrapolate(problem, beta);
          SweepSums sums = sweep<true, true>(problem, beta);
          ++solution.sweeps;
          if (solution.sweeps > forward_sweeps)
            {
              sums = sweep<false, false>(problem);
              ++solution.sweeps;
            }

          const double change = relative_change(sums, problem);
          if (change <= tolerance.allowance(solution.sweeps) * tolerance.residual)
            {
              measure_residual(problem, solution);
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
              const double now = kinetic_energy(problem) + sums.work;
              if (now > objective && change > last_change)
                t = 1.;
              objective   = now;
              last_change = change;
            }
          const double t_next = 0.5 * (1. + std::sqrt(1. + 4. * t * t));
          beta                = std::min(cap, (t - 1.) / t_next);
          t                   = t_next;
        }
      measure_residual(problem, solution);
      return solution;
    }

  private:
    unsigned int forward_sweeps = 1000;
    unsigned int stall_sweeps   = 100;

    mutable std::vector<DiscVelocity> last; // velocities of the iteration before; kept to save the allocation

    void extrapolate(ContactProblem &problem, const double beta) const
    {
      for (std::size_t k = 0; k < last.size(); ++k)
        {
          DiscVelocity      &v   = problem.velocity[k];
          const DiscVelocity now = v;
          v.x += beta * (now.x - last[k].x);
          v.y += beta * (now.y - last[k].y);
          v.s += beta * (now.s - last[k].s);
          last[k] = now;
        }
    }

    static double kinetic_energy(const ContactProblem &problem)
    {
      double energy = 0.;
      for (std::size_t k = 0; k < problem.mass.size(); ++k)
        {
          const DiscVelocity &v = problem.velocity[k];
          energy += problem.mass[k].translation * (v.x * v.x + v.y * v.y) + problem.mass[k].rotation * v.s * v.s;
        }
      return 0.5 * energy;
    }
  };

  ALLUVIUM_REGISTER(ContactSolver,
                    AcceleratedGaussSeidel,
                    "accelerated Gauss-Seidel",
                    "Gauss-Seidel sweeps with Nesterov momentum: about 3 n sweeps on a cold bed of n layers.")
} // namespace alluvium::grains
