#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_relax.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/moment_correction.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>

namespace alluvium::contacts
{
  /**
   * Projected successive over-relaxation: Gauss-Seidel sweeps that go further than each contact's own solution, then
   * back onto its friction cone. Between plain and accelerated Gauss-Seidel, with a number to choose.
   */
  class OverRelaxation : public ContactSolver
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter(
        "Relaxation",
        relaxation,
        "How far each contact goes towards its own solution [-]: 1, Gauss-Seidel; more, further. Above 1.3, "
        "friction keeps beds from converging: at 1.5 a bed at rest costs 70 times as much.",
        dealii::Patterns::Double(0.1, 1.99));
    }

    ContactSolution solve(ContactProblem &problem, const ContactTolerance &tolerance) const override
    {
      ContactSolution solution;
      apply_impulses(problem);
      ContactMeasure measure(problem);
      while (solution.sweeps < tolerance.max_sweeps)
        {
          ContactMeasure::Sums sums = measure.begin();
          for (unsigned int colour = 0; colour < problem.n_colours(); ++colour)
            {
              for (std::size_t k = problem.colour_begin[colour]; k < problem.colour_begin[colour + 1]; ++k)
                {
                  // As if the discs' inverse masses were smaller
                  const double   change = relax(problem, k, 1. / relaxation, 1. / relaxation);
                  const Contact &c      = problem.contacts[k];
                  if (problem.counts(c))
                    {
                      sums.change.add(change);
                      sums.size.add(c.rn * c.rn + c.rt * c.rt);
                    }
                }
              if (problem.communicator != nullptr)
                problem.communicator->after_colour(problem.discs, colour);
            }
          ++solution.sweeps;
          if (is_solved(measure, measure.end(sums), tolerance, solution, relaxation))
            return solution;
          correct_if_due(problem, solution.sweeps);
        }
      give_up(measure, tolerance, solution);
      return solution;
    }

  private:
    double relaxation = 1.2;
  };

  ALLUVIUM_REGISTER(ContactSolver,
                    OverRelaxation,
                    "SOR",
                    "projected successive over-relaxation: Gauss-Seidel sweeps with longer steps.")
} // namespace alluvium::contacts
