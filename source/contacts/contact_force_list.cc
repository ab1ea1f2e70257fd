#include <alluvium/contacts/contact_force_list.h>

#include <algorithm>

namespace alluvium::contacts
{
  std::vector<ContactForce> list_contact_forces(const LocalContactProblem &local,
                                                const grains::GrainArrays &grains,
                                                const SoftSpheres *const   soft_spheres,
                                                const Cohesion *const      cohesion)
  {
    std::vector<ContactForce> result;
    if (!local.fits(grains))
      return result;
    const ContactGeometry &geometry = local.geometry;
    const double           h        = local.neighbours.substep();
    const auto             add      = [&](const ContactPair &p, const bool wall) {
      ContactPoint point;
      if (p.rn == 0. && !p.bonded)
        return;
      if (wall &&
          !geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point))
        return;
      if (!wall)
        point = touch(grains, geometry.periodicity, p.i, p.j);
      const double ri = grains.radius[p.i], rj = wall ? 0. : grains.radius[p.j];
      ContactForce f{p.i, p.j, wall, point.nx, point.ny, ri + rj + point.gap, p.rn, 0.};
      if (soft_spheres)
        f.tangential = soft_spheres->spring_force(p);
      else
        {
          f.normal     = p.rn / h;
          f.tangential = p.rt / h;
          if (cohesion && p.bonded)
            f.normal -= cohesion->force(std::max(point.gap, 0.), wall ? ri : ri * rj / (ri + rj));
        }
      result.push_back(f);
    };
    const auto number = [&](const grains::GrainId id) {
      return static_cast<std::uint32_t>(std::lower_bound(grains.id.begin(), grains.id.end(), id) - grains.id.begin());
    };
    for (const ContactArchive::Entry &e : local.archive().entries)
      {
        ContactPair p{number(e.a), e.wall ? ~e.b : number(e.b)};
        p.bonded = e.bonded;
        p.rn     = e.rn;
        p.rt     = e.rt;
        add(p, e.wall);
      }
    return result;
  }
} // namespace alluvium::contacts
