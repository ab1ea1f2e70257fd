#include <alluvium/contacts/contact_plausibility.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  MotionSums sum_motion(const std::vector<Disc> &discs,
                        const std::size_t        n,
                        const std::size_t        n_all,
                        ContactCommunicator     *communicator)
  {
    const auto sums = sum_over_ranks<3>(communicator, n, n_all, [&](const std::size_t k) -> std::array<double, 3> {
      const Disc &v = discs[k];
      if (v.inverse_mass == 0.)
        return {};
      const double square = v.x * v.x + v.y * v.y, mass = 1. / v.inverse_mass;
      double       momentum = mass * std::sqrt(square), energy = 0.5 * mass * square;
      if (v.inverse_rotation > 0.)
        {
          momentum += std::abs(v.s) / v.inverse_rotation;
          energy += 0.5 * v.s * v.s / v.inverse_rotation;
        }
      return {{mass, momentum, energy}};
    });
    return {sums[0], sums[1], sums[2]};
  }

  bool has_diverged(const double largest, const MotionSums &before, const double extra)
  {
    return largest > 30. * (before.momentum + before.mass * extra);
  }

  bool has_gained_energy(const ContactProblem &problem,
                         const std::size_t     n_all,
                         const MotionSums     &before,
                         const double          extra)
  {
    const double     allowed = before.energy + before.mass * extra * extra;
    const MotionSums after   = sum_motion(problem.discs, problem.n_owned_discs, n_all, problem.communicator);
    return after.energy > allowed * (1. + 1e-9);
  }
} // namespace alluvium::contacts
