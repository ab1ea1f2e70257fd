#include <alluvium/grains/contact_bodies.h>
#include <alluvium/grains/contact_reductions.h>

#include <cmath>

namespace alluvium::grains
{
  void ContactBodies::set(const GrainArrays &grains, const GrainLoads &loads, const double h, const bool rotation)
  {
    const std::size_t n = grains.n();
    start.resize(n);
    free.assign(n + n_dummies, Disc());
    for (std::size_t k = 0; k < n; ++k)
      {
        start[k] = {grains.vx[k], grains.vy[k], grains.radius[k] * grains.omega[k]};
        if (std::isinf(grains.mass[k]))
          {
            free[k] = start[k];
            continue;
          }
        const double m = grains.mass[k], m_e = m + h * loads.drag[k];
        const double inverse     = 1. / m_e;
        free[k].x                = (m * start[k].x + h * loads.fx[k]) * inverse;
        free[k].y                = (m * start[k].y + h * loads.fy[k]) * inverse;
        free[k].s                = start[k].s;
        free[k].inverse_mass     = inverse;
        free[k].inverse_rotation = rotation ? 1. / disc_inertia(m, 1.) : 0.;
      }
  }

  std::array<double, 2> largest_speeds(const std::vector<Disc> &velocities, const std::size_t n)
  {
    double first = 0., second = 0.;
    for (std::size_t k = 0; k < n; ++k)
      {
        const double s = velocities[k].x * velocities[k].x + velocities[k].y * velocities[k].y;
        if (s > first)
          {
            second = first;
            first  = s;
          }
        else if (s > second)
          second = s;
      }
    return {{std::sqrt(first), std::sqrt(second)}};
  }

  double root_mean_square_speed(const std::vector<Disc>   &velocities,
                                const std::size_t          n,
                                const std::size_t          n_all,
                                ContactCommunicator *const communicator)
  {
    const auto sum = sum_over_ranks<1>(communicator, n, n_all, [&](const std::size_t k) {
      const Disc &v = velocities[k];
      return std::array<double, 1>{{v.x * v.x + v.y * v.y}};
    });
    return std::sqrt(sum[0] / n_all);
  }
} // namespace alluvium::grains
