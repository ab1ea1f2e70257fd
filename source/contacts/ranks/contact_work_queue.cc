#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_relax.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/contact_sweep.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  /**
   * Gauss-Seidel that only visits contacts whose neighbourhood still changes: after one sweep over all, a contact waits
   * until the impulse of a contact with one of its discs has changed by more than a fraction of the tolerance. For beds
   * in which little happens, in few places. Where much happens, or the queue does not run dry soon, the accelerated
   * Gauss-Seidel takes over at once.
   */
  class WorkQueue : public ContactSolver, public Composite<ContactSolver>
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Largest queue",
                        largest_queue,
                        "If more than this part of all contacts waits after a sweep, full sweeps take over [-].",
                        dealii::Patterns::Double(0., 1.));
      prm.add_parameter(
        "Threshold",
        threshold,
        "A contact wakes its neighbours if it changes by more than this times the residual tolerance [-].",
        dealii::Patterns::Double(0.));
    }

    ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const override
    {
      refuse_ranks(problem, "work queue");
      const std::vector<Disc> free = problem.discs;
      ContactSolution         solution;
      apply_impulses(problem);
      ContactMeasure measure(problem);
      find_neighbours(problem);
      const std::size_t n      = problem.contacts.size();
      std::size_t       visits = 0;
      const double      limit  = std::pow(threshold * tolerance.residual * problem.impulse_scale, 2);

      // Contacts wait in the order of their colours, as sweeps would visit them.
      waiting.assign(n, 1);
      std::size_t n_waiting = n;
      while (visits < most_sweeps * n)
        {
          const std::size_t n_visited = n_waiting;
          for (std::size_t k = 0; k < n; ++k)
            if (waiting[k])
              {
                waiting[k] = 0;
                --n_waiting;
                if (relax(problem, k) > limit)
                  for (std::uint32_t m = begin[k]; m < begin[k + 1]; ++m)
                    if (!waiting[neighbour[m]])
                      {
                        waiting[neighbour[m]] = 1;
                        ++n_waiting;
                      }
              }
          visits += n_visited;
          solution.sweeps = static_cast<unsigned int>((visits + n - 1) / std::max<std::size_t>(1, n));
          if (n_waiting == 0)
            {
              measure_residual(measure, solution);
              solution.converged = solution.meets(tolerance);
              if (solution.converged)
                return solution;
              break;
            }
          if (n_waiting > largest_queue * n)
            break;
        }
      problem.discs          = free;
      ContactSolution others = part(fallback).solve(problem, tolerance);
      others.sweeps += solution.sweeps;
      return others;
    }

    std::vector<std::string> parts() const override { return {fallback}; }

  private:
    static constexpr const char  *fallback    = "accelerated Gauss-Seidel";
    static constexpr unsigned int most_sweeps = 10; // worth of visits

    double largest_queue = 0.2;
    double threshold     = 0.3;

    mutable std::vector<std::uint8_t>  waiting;
    mutable std::vector<std::uint32_t> begin, neighbour; // contacts that share a disc with contact k

    void find_neighbours(const ContactProblem &problem) const
    {
      const std::size_t          n = problem.contacts.size();
      std::vector<std::uint32_t> first(problem.n_discs + 1, 0), of_disc;
      const auto                 for_discs = [&](const Contact &c, const auto &action) {
        action(c.i);
        if (c.j < problem.n_discs)
          action(c.j);
      };
      for (const Contact &c : problem.contacts)
        for_discs(c, [&](const std::uint32_t d) { ++first[d + 1]; });
      for (std::size_t d = 0; d < problem.n_discs; ++d)
        first[d + 1] += first[d];
      of_disc.resize(first.back());
      std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
      for (std::size_t k = 0; k < n; ++k)
        for_discs(problem.contacts[k], [&](const std::uint32_t d) { of_disc[end[d]++] = k; });
      begin.assign(1, 0);
      neighbour.clear();
      for (std::size_t k = 0; k < n; ++k)
        {
          for_discs(problem.contacts[k], [&](const std::uint32_t d) {
            for (std::uint32_t m = first[d]; m < first[d + 1]; ++m)
              if (of_disc[m] != k)
                neighbour.push_back(of_disc[m]);
          });
          begin.push_back(neighbour.size());
        }
    }
  };

  ALLUVIUM_REGISTER(
    ContactSolver,
    WorkQueue,
    "work queue",
    "visits only contacts whose neighbourhood still changes; accelerated Gauss-Seidel where that is many.")
} // namespace alluvium::contacts
