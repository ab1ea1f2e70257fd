#include <alluvium/grains/contact_relax.h>
#include <alluvium/grains/contact_solver.h>
#include <alluvium/utilities/user_error.h>

namespace alluvium::grains
{
  void apply_impulses(ContactProblem &problem)
  {
    for (const Contact &c : problem.contacts)
      push(problem, c, c.rn, c.rt);
    for (std::size_t k = 0; k < problem.rolling.size(); ++k)
      {
        RollingFriction &r = problem.rolling[k];
        roll(r, problem.discs[problem.contacts[k].i], problem.discs[problem.contacts[k].j], r.impulse);
        r.last = r.impulse;
      }
    if (problem.communicator != nullptr)
      problem.communicator->update_ghosts(problem.discs);
  }

  void refuse_ranks(const ContactProblem &problem, const std::string &solver)
  {
    check_user(problem.communicator == nullptr,
               "Contact solver: '" + solver +
                 "' runs on one rank only. Choose 'accelerated Gauss-Seidel', or run without mpirun.");
  }
} // namespace alluvium::grains
