#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    /** The largest and the second largest of @p n values(k), which are not negative. */
    template <class Values>
    std::array<double, 2> two_largest(const std::size_t n, const Values &values)
    {
      double first = 0., second = 0.;
      for (std::size_t k = 0; k < n; ++k)
        {
          const double value = values(k);
          if (value > first)
            {
              second = first;
              first  = value;
            }
          else if (value > second)
            second = value;
        }
      return {{first, second}};
    }
  } // namespace

  void ContactBodies::set(const grains::GrainArrays &grains,
                          const grains::GrainLoads  &loads,
                          const double               h,
                          const bool                 rotation)
  {
    const std::size_t n = grains.n();
    free.resize(n + n_dummies);
    std::fill(free.begin() + n, free.end(), Disc());
    for (std::size_t k = 0; k < n; ++k)
      {
        Disc &d = free[k];
        d       = {grains.velocity[0][k], grains.velocity[1][k], grains.radius[k] * grains.omega[k]};
        if (std::isinf(grains.mass[k]))
          continue;
        const double m = grains.mass[k] + loads.mass_added_to(k), m_e = m + h * loads.drag[k];
        const double inverse = 1. / m_e;
        d.x                  = (m * d.x + h * loads.force[0][k]) * inverse;
        d.y                  = (m * d.y + h * loads.force[1][k]) * inverse;
        d.inverse_mass       = inverse;
        d.inverse_rotation   = 0.;
        if (!rotation)
          continue;
        const double inertia = grains::disc_inertia(grains.mass[k], 1.); // for s = r omega
        d.inverse_rotation   = 1. / inertia;
        if (!loads.torque.empty())
          {
            const double r     = grains.radius[k];
            d.inverse_rotation = 1. / (inertia + h * loads.spin_drag[k] / (r * r));
            d.s                = (inertia * d.s + h * loads.torque[k] / r) * d.inverse_rotation;
          }
      }
  }

  std::array<double, 2> largest_speeds(const std::vector<Disc> &velocities, const std::size_t n)
  {
    const auto squares = two_largest(
      n, [&](const std::size_t k) { return velocities[k].x * velocities[k].x + velocities[k].y * velocities[k].y; });
    return {{std::sqrt(squares[0]), std::sqrt(squares[1])}};
  }

  GrainSpeeds measure_speeds(const grains::GrainArrays &grains,
                             const std::size_t          n,
                             const std::size_t          n_all,
                             ContactCommunicator *const communicator)
  {
    const auto square = [&](const std::size_t k) {
      return grains.velocity[0][k] * grains.velocity[0][k] + grains.velocity[1][k] * grains.velocity[1][k];
    };
    const auto largest = largest_over_ranks(communicator, two_largest(n, square));
    // As sum_over_ranks(), which would look for the largest once more
    ReproducibleSum sum(n_all * largest[0]);
    for (std::size_t k = 0; k < n; ++k)
      sum.add(square(k));
    double all = sum.value();
    if (communicator != nullptr)
      communicator->sum(&all, 1);
    return {{{std::sqrt(largest[0]), std::sqrt(largest[1])}}, std::sqrt(all / n_all)};
  }
} // namespace alluvium::contacts
