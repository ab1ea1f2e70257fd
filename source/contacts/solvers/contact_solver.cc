#include <alluvium/contacts/solvers/contact_relax.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/utilities/user_error.h>

#include <cmath>
#include <utility>

namespace alluvium::contacts
{
  bool is_consistent(const ContactProblem &problem)
  {
    const std::size_t n = problem.discs.size();
    if (problem.n_owned_discs > problem.n_discs || problem.n_discs > n ||
        !(problem.rolling.empty() || problem.rolling.size() == problem.contacts.size()) ||
        (problem.n_colours() > 0 &&
         (problem.colour_begin.front() != 0 || problem.colour_begin.back() != problem.contacts.size())))
      return false;
    for (const Contact &c : problem.contacts)
      if (c.i >= problem.n_discs || c.j >= n || c.i == c.j || std::abs(std::hypot(c.nx, c.ny) - 1.) > 1e-9)
        return false;
    std::vector<std::size_t> colour_of(problem.n_discs, problem.n_colours());
    for (std::size_t colour = 0; colour < problem.n_colours(); ++colour)
      for (std::size_t k = problem.colour_begin[colour]; k < problem.colour_begin[colour + 1]; ++k)
        for (const std::uint32_t disc : {problem.contacts[k].i, problem.contacts[k].j})
          if (disc < problem.n_discs && std::exchange(colour_of[disc], colour) == colour)
            return false;
    return true;
  }

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
} // namespace alluvium::contacts
