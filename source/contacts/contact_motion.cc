#include <alluvium/contacts/contact_motion.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  unsigned int ContactMotion::move(const ContactProblem   &problem,
                                   const ContactActiveSet &active,
                                   const ContactBodies    &bodies,
                                   const ContactBonds     &bonds,
                                   const double            h,
                                   const bool              rotation,
                                   LocalContactProblem    &local)
  {
    on_grain.assign(bodies.n_discs() + ContactBodies::n_dummies, {});
    const ContactCandidates   &pairs      = local.neighbours.pairs;
    std::vector<std::uint8_t> &touches    = local.touched();
    grains::GrainArrays       &grains     = local.grains();
    const auto                &walls      = local.geometry.walls.segments();
    unsigned int               n_contacts = 0;
    from_contacts.clear();
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact &c = problem.contacts[k];
        if (c.rn == 0. && c.rt == 0.)
          continue;
        n_contacts += problem.counts(c);
        const double ix = c.rn * c.nx - c.rt * c.ny, iy = c.rn * c.ny + c.rt * c.nx;
        Impulse     &i = on_grain[c.i], &j = on_grain[c.j];
        i.x -= ix;
        i.y -= iy;
        i.spin -= c.rt;
        j.x += ix;
        j.y += iy;
        j.spin -= c.rt;
        if (!problem.rolling.empty())
          {
            i.spin -= problem.rolling[k].lever_i * problem.rolling[k].impulse;
            j.spin += problem.rolling[k].lever_j * problem.rolling[k].impulse;
          }
        touches[c.i] = 1;
        if (active.is_wall(k, pairs))
          {
            const std::size_t w    = active.pair(k, pairs).j;
            const auto       &wall = walls[w];
            double            work = 0.;
            if (wall.velocity[0] != 0. || wall.velocity[1] != 0. || wall.spin != 0.)
              {
                const double r = grains.radius[c.i];
                const auto v = wall.velocity_at(grains.position[0][c.i] + r * c.nx, grains.position[1][c.i] + r * c.ny);
                work         = -(ix * v[0] + iy * v[1]);
              }
            from_contacts.push_back({w, {{ix, iy, work}}});
          }
        else
          touches[c.j] = 1;
      }
    add_wall_impulses(local.communicator());
    for (std::size_t k = 0; k < local.n_owned(); ++k)
      {
        const Impulse &p      = on_grain[k];
        grains.velocity[0][k] = bodies.free[k].x + bodies.free[k].inverse_mass * p.x;
        grains.velocity[1][k] = bodies.free[k].y + bodies.free[k].inverse_mass * p.y;
        if (rotation)
          // the first difference is the fluid's torque, and exactly zero without one
          grains.omega[k] +=
            (bodies.free[k].s - grains.radius[k] * grains.omega[k] + bodies.free[k].inverse_rotation * p.spin) /
            grains.radius[k];
        grains.position[0][k] += h * grains.velocity[0][k];
        grains.position[1][k] += h * grains.velocity[1][k];
        grains.contact_force[0][k] += p.x;
        grains.contact_force[1][k] += p.y;
      }
    wrap_into_box(grains, local.geometry.periodicity);
    local.update_ghosts();
    for (std::size_t k = 0; k < bonds.on_grain.size(); ++k)
      {
        grains.contact_force[0][k] += bonds.on_grain[k][0];
        grains.contact_force[1][k] += bonds.on_grain[k][1];
      }
    for (std::size_t k = 0; k < bonds.on_wall.size(); ++k)
      {
        for (unsigned int d = 0; d < 2; ++d)
          on_wall[k][d] += bonds.on_wall[k][d];
        on_wall[k][2] += speed_of(walls[k]) * std::hypot(bonds.on_wall[k][0], bonds.on_wall[k][1]); // at most
      }
    return n_contacts;
  }

  /** Sum what each wall got from contacts in a sub-step; as sum_over_ranks(), but all walls at once. */
  void ContactMotion::add_wall_impulses(ContactCommunicator *const communicator)
  {
    if (on_wall.empty())
      return;
    constexpr unsigned int             n     = 3;
    const std::size_t                  n_all = count_over_ranks(communicator, from_contacts.size());
    std::vector<std::array<double, 3>> sums(on_wall.size(), {{0., 0., 0.}});
    for (const WallImpulse &p : from_contacts)
      for (unsigned int d = 0; d < n; ++d)
        sums[p.wall][d] = std::max(sums[p.wall][d], std::abs(p.impulse[d]));
    if (communicator != nullptr)
      communicator->max(sums[0].data(), n * sums.size());
    std::vector<std::array<double, 3>> shifts(sums.size());
    for (std::size_t w = 0; w < sums.size(); ++w)
      for (unsigned int d = 0; d < n; ++d)
        shifts[w][d] = ReproducibleSum(n_all * sums[w][d]).unit_shift();
    sums.assign(sums.size(), {{0., 0., 0.}});
    for (const WallImpulse &p : from_contacts)
      for (unsigned int d = 0; d < n; ++d)
        sums[p.wall][d] += (p.impulse[d] + shifts[p.wall][d]) - shifts[p.wall][d];
    if (communicator != nullptr)
      communicator->sum(sums[0].data(), n * sums.size());
    for (std::size_t w = 0; w < sums.size(); ++w)
      for (unsigned int d = 0; d < n; ++d)
        on_wall[w][d] += sums[w][d];
  }
} // namespace alluvium::contacts
