#include <alluvium/grains/contact_plausibility.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  MotionSums sum_motion(const std::vector<Disc> &discs, const std::size_t n)
  {
    MotionSums sums;
    for (std::size_t k = 0; k < n; ++k)
      {
        const Disc &v = discs[k];
        if (v.inverse_mass == 0.)
          continue;
        const double square = v.x * v.x + v.y * v.y, mass = 1. / v.inverse_mass;
        sums.mass += mass;
        sums.momentum += mass * std::sqrt(square);
        sums.energy += 0.5 * mass * square;
        if (v.inverse_rotation > 0.)
          {
            sums.momentum += std::abs(v.s) / v.inverse_rotation;
            sums.energy += 0.5 * v.s * v.s / v.inverse_rotation;
          }
      }
    return sums;
  }

  bool has_runaway_impulse(const ContactProblem &problem, const MotionSums &before, const double extra)
  {
    double largest = 0.;
    for (const Contact &c : problem.contacts)
      largest = std::max(largest, c.rn);
    return largest > 30. * (before.momentum + before.mass * extra);
  }

  bool has_gained_energy(const ContactProblem &problem, const MotionSums &before, const double extra)
  {
    const double allowed = before.energy + before.mass * extra * extra;
    return sum_motion(problem.discs, problem.n_discs).energy > allowed * (1. + 1e-9);
  }
} // namespace alluvium::grains
