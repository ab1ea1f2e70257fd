#include <alluvium/contacts/contact_force.h>

#include <cmath>

namespace alluvium::contacts
{
  std::vector<std::array<double, 4>> grain_stresses(const grains::GrainArrays       &grains,
                                                    const std::vector<ContactForce> &forces)
  {
    std::vector<std::array<double, 4>> stress(grains.n(), {{0., 0., 0., 0.}});
    const auto add = [&](const std::uint32_t k, const double nx, const double ny, const double fx, const double fy) {
      const double scale = 1. / (M_PI * grains.radius[k]); // r over the area
      stress[k][0] += scale * nx * fx;
      stress[k][1] += scale * nx * fy;
      stress[k][2] += scale * ny * fx;
      stress[k][3] += scale * ny * fy;
    };
    for (const ContactForce &c : forces)
      {
        const double fx = c.normal * c.nx - c.tangential * c.ny, fy = c.normal * c.ny + c.tangential * c.nx;
        add(c.i, c.nx, c.ny, -fx, -fy);
        if (!c.wall)
          add(c.j, -c.nx, -c.ny, fx, fy);
      }
    return stress;
  }
} // namespace alluvium::contacts
