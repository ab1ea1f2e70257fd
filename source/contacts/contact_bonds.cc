#include <alluvium/contacts/contact_bonds.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    bool find_point(const grains::GrainArrays &grains,
                    const ContactGeometry     &geometry,
                    const ContactPair         &p,
                    const bool                 wall,
                    ContactPoint              &point)
    {
      if (wall)
        return geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point);
      point = touch(grains, geometry.periodicity, p.i, p.j);
      return true;
    }

    double reduced_radius(const grains::GrainArrays &grains, const ContactPair &p, const bool wall)
    {
      const double ri = grains.radius[p.i];
      return wall ? ri : ri * grains.radius[p.j] / (ri + grains.radius[p.j]);
    }
  } // namespace

  void ContactBonds::reset(const std::size_t n_discs, const std::size_t n_walls)
  {
    on_grain.assign(n_discs, {{0., 0.}});
    on_wall.assign(n_walls, {{0., 0.}});
  }

  void ContactBonds::attract(const grains::GrainArrays &grains,
                             const ContactGeometry     &geometry,
                             const Cohesion            &cohesion,
                             const double               h,
                             const double               closed,
                             ContactCandidates         &candidates,
                             ContactBodies             &bodies)
  {
    for (const bool wall : {false, true})
      for (ContactPair &p : wall ? candidates.walls : candidates.discs)
        {
          ContactPoint point;
          if (!find_point(grains, geometry, p, wall, point) || !(p.bonded || point.gap <= closed))
            continue;
          p.bonded             = true;
          const double impulse = h * cohesion.force(std::max(point.gap, 0.), reduced_radius(grains, p, wall));
          const double px = impulse * point.nx, py = impulse * point.ny;
          on_grain[p.i][0] += px;
          on_grain[p.i][1] += py;
          auto &other = wall ? on_wall[p.j] : on_grain[p.j];
          other[0] -= px;
          other[1] -= py;
        }
    for (std::size_t k = 0; k < on_grain.size(); ++k)
      {
        bodies.free[k].x += bodies.free[k].inverse_mass * on_grain[k][0];
        bodies.free[k].y += bodies.free[k].inverse_mass * on_grain[k][1];
      }
  }

  void ContactBonds::update(const grains::GrainArrays &grains,
                            const ContactGeometry     &geometry,
                            const Cohesion            &cohesion,
                            ContactCandidates         &candidates)
  {
    for (const bool wall : {false, true})
      for (ContactPair &p : wall ? candidates.walls : candidates.discs)
        if (p.rn > 0.)
          p.bonded = true;
        else if (p.bonded)
          {
            const double reach = cohesion.reach(reduced_radius(grains, p, wall));
            ContactPoint point;
            p.bonded = reach > 0. && find_point(grains, geometry, p, wall, point) && point.gap <= reach;
          }
  }
} // namespace alluvium::contacts
