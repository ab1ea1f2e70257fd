#include <alluvium/contacts/contact_scales.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/divergence.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace alluvium::contacts
{
  ContactScales make_scales(const grains::GrainArrays &grains, const std::array<double, 2> gravity)
  {
    ContactScales scales;
    const auto [r_min, r_max] = std::minmax_element(grains.radius.begin(), grains.radius.end());
    scales.d_min              = 2. * *r_min;
    scales.d_max              = 2. * *r_max;
    scales.g                  = std::hypot(gravity[0], gravity[1]);
    if (scales.g > 0.)
      scales.down = {{gravity[0] / scales.g, gravity[1] / scales.g}};
    double sum = 0.;
    for (const double m : grains.mass)
      {
        sum += 1. / m;
        if (std::isinf(m))
          continue;
        scales.mass += m;
        scales.heaviest = std::max(scales.heaviest, m);
        scales.lightest = scales.lightest > 0. ? std::min(scales.lightest, m) : m;
      }
    scales.mean_mass = sum > 0. ? grains.n() / sum : 1.;
    return scales;
  }

  unsigned int count_substeps(const grains::GrainArrays &grains,
                              const grains::GrainLoads  &loads,
                              const double               dt,
                              const double               largest_move)
  {
    double      speed   = 0.;
    std::size_t fastest = 0;
    const auto  see     = [&](const std::size_t k, const double square) {
      if (square > speed)
        {
          speed   = square;
          fastest = k;
        }
    };
    for (std::size_t k = 0; k < grains.n(); ++k)
      {
        const double m  = grains.mass[k] + loads.mass_added_to(k);
        double       vx = grains.velocity[0][k], vy = grains.velocity[1][k];
        see(k, vx * vx + vy * vy);
        if (!std::isinf(m))
          {
            vx               = m * vx + dt * (loads.force[0][k] + grains.contact_force[0][k]);
            vy               = m * vy + dt * (loads.force[1][k] + grains.contact_force[1][k]);
            const double m_e = m + dt * loads.drag[k];
            // Most grains are not the fastest, which takes no division to see.
            if (!(vx * vx + vy * vy < 0.999 * speed * m_e * m_e))
              {
                vx /= m_e;
                vy /= m_e;
                see(k, vx * vx + vy * vy);
              }
          }
        if (!std::isfinite(vx * vx + vy * vy + grains.position[0][k] + grains.position[1][k]))
          throw Divergence("The position, the velocity or the load of grain " + std::to_string(grains.id[k]) +
                           " is not a finite number.");
      }
    const double n_substeps = std::ceil(dt * std::sqrt(speed) / largest_move * (1. - 1e-10));
    if (n_substeps > 1e6)
      {
        // a part of the smallest diameter is as far as any grain may go
        const std::size_t smallest =
          std::min_element(grains.radius.begin(), grains.radius.end()) - grains.radius.begin();
        constexpr double much      = 100.;
        const auto       described = [&](const std::size_t k) {
          return "Grain " + std::to_string(grains.id[k]) + " at (" + in_digits(grains.position[0][k]) + ", " +
                 in_digits(grains.position[1][k]) + ") m";
        };
        std::string why = described(fastest) + " moves at " + in_digits(std::sqrt(speed)) + " m/s: a step of " +
                          in_digits(dt) + " s would need more than a million contact sub-steps.";
        if (grains.radius[fastest] > much * grains.radius[smallest])
          why = described(smallest) + " has a radius of " + in_digits(grains.radius[smallest]) +
                " m: in a contact sub-step no grain may go farther than " + in_digits(largest_move) + " m. " + why;
        throw Divergence(why);
      }
    return std::max(1., n_substeps);
  }
} // namespace alluvium::contacts
