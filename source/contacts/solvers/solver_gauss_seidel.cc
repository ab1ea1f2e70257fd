#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_relax.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/contact_sweep.h>
#include <alluvium/contacts/solvers/moment_correction.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <numeric>

namespace alluvium::contacts
{
  /**
   * Plain non-linear Gauss-Seidel (Jean & Moreau's NSCD iteration). Cheapest per sweep; a cold pile of n layers needs
   * some 2.7 n^2 sweeps in any order, so it is for shallow or nearly settled scenes and for comparison.
   */
  class GaussSeidel : public ContactSolver
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter(
        "Order",
        order,
        "In which order contacts are relaxed. colour: those that share no grain together, four at a time, which "
        "is fastest; file: by the grains' places in the arrays; gravity: from the top down. The last two run on one "
        "rank only.",
        dealii::Patterns::Selection("colour|file|gravity"));
    }

    ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const override
    {
      ContactSolution solution;
      if (order != "colour")
        {
          refuse_ranks(problem, "Gauss-Seidel' with 'Order = " + order);
          sort(problem);
        }
      apply_impulses(problem);
      ContactMeasure measure(problem);
      while (solution.sweeps < tolerance.max_sweeps)
        {
          const SweepSums sums = order == "colour" ? sweep(problem, measure) : sweep_sorted(problem, measure);
          ++solution.sweeps;
          if (is_solved(measure, sums, tolerance, solution))
            return solution;
          correct_if_due(problem, solution.sweeps);
        }
      give_up(measure, tolerance, solution);
      return solution;
    }

  private:
    std::string order = "colour";

    mutable std::vector<std::uint32_t> sequence; // of the contacts, if not by colour

    void sort(const ContactProblem &problem) const
    {
      const std::vector<Contact> &contacts = problem.contacts;
      sequence.resize(contacts.size());
      std::iota(sequence.begin(), sequence.end(), 0);
      const auto by_file = [&](const std::uint32_t a, const std::uint32_t b) {
        return contacts[a].i != contacts[b].i ? contacts[a].i < contacts[b].i : contacts[a].j < contacts[b].j;
      };
      std::sort(sequence.begin(), sequence.end(), by_file);
      if (order == "gravity" && !problem.height.empty())
        {
          const auto height = [&](const Contact &c) {
            const double i = problem.height[c.i];
            return c.j < problem.n_discs ? 0.5 * (i + problem.height[c.j]) : i;
          };
          std::stable_sort(sequence.begin(), sequence.end(), [&](const std::uint32_t a, const std::uint32_t b) {
            return height(contacts[a]) > height(contacts[b]);
          });
        }
    }

    SweepSums sweep_sorted(ContactProblem &problem, ContactMeasure &measure) const
    {
      ContactMeasure::Sums sums = measure.begin();
      for (const std::uint32_t k : sequence)
        {
          const Contact &c = problem.contacts[k];
          sums.change.add(relax(problem, k));
          sums.size.add(c.rn * c.rn + c.rt * c.rt);
        }
      return measure.end(sums);
    }
  };

  ALLUVIUM_REGISTER(
    ContactSolver,
    GaussSeidel,
    "Gauss-Seidel",
    "plain non-linear Gauss-Seidel sweeps: cheap per sweep, but a cold bed of n layers needs about 2.7 n^2 "
    "of them.")
} // namespace alluvium::contacts
