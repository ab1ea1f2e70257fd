#include <alluvium/contacts/contact_active_set.h>
#include <alluvium/contacts/contact_pair_geometry.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    /** Make room for one more; a vector that doubles would waste memory. */
    template <class T>
    void make_room(std::vector<T> &list)
    {
      if (list.size() == list.capacity())
        list.reserve(list.size() + list.size() / 8 + 64);
    }
  } // namespace

  void ContactActiveSet::select(const grains::GrainArrays &grains,
                                const ContactBodies       &bodies,
                                const ContactGeometry     &geometry,
                                const ContactMaterials    &materials,
                                const ContactMargins      &margins,
                                const bool                 keep,
                                const unsigned int         n_colours,
                                ContactCandidates         &candidates,
                                ContactProblem            &problem)
  {
    const double h = margins.h, delta = margins.delta, alert_distance = margins.alert_distance;
    if (!keep)
      {
        disc_takes_part.assign(candidates.discs.size(), 0);
        wall_takes_part.assign(candidates.walls.size(), 0);
      }
    number.clear();
    states.clear();
    coefficients.clear();
    n_closed = n_warm = 0;
    problem.contacts.clear();
    problem.rolling.clear();
    problem.colour_begin.assign(1, 0);

    const auto add = [&](const ContactPair &p, const std::size_t n, const double gap) -> Contact & {
      make_room(number);
      number.push_back(n);
      const unsigned int closed = (gap <= delta) & (p.i < problem.n_owned_discs);
      n_closed += closed;
      n_warm += closed & (p.rn > 0.);
      make_room(problem.contacts);
      Contact &contact = problem.contacts.emplace_back(); // to be written in place: a copy would wait for its stores
      contact.rn       = p.rn;
      contact.rt       = p.rt;
      contact.i        = p.i;
      return contact;
    };
    const auto add_rolling =
      [&](const ContactPair &p, const double lever_i, const double lever_j, const double wall, const double rolling) {
        make_room(problem.rolling);
        problem.rolling.push_back({p.rr, p.rr, lever_i, lever_j, wall, rolling});
      };

    const auto add_state = [&](const ContactMaterial &material, const ContactState &state) {
      states.push_back(state);
      coefficients.push_back(material);
    };
    const auto spin = [&](const std::uint32_t k) { return grains.radius[k] * grains.omega[k]; };

    const auto &free        = bodies.free;
    const auto  select_disc = [&](const std::size_t k, const PairGeometry &all, const unsigned int m) {
      ContactPair &p   = candidates.discs[k];
      const double gap = all.gap[m], approach = all.approach[m];
      if (!(keep && disc_takes_part[k]) && gap >= alert_distance &&
          (gap - alert_distance) * all.distance[m] + h * approach >= 0.)
        {
          p.rn = p.rt = p.rr = 0.;
          return;
        }
      if (free[p.i].inverse_mass + free[p.j].inverse_mass == 0.)
        return;
      disc_takes_part[k]              = 1;
      const ContactMaterial &material = materials.grains;
      const double           nx = all.nx[m], ny = all.ny[m], free_vn = all.vn[m];
      double                 start_vn = 0.;
      if (material.restitution > 0. || materials.law)
        start_vn = (grains.velocity[0][p.j] - grains.velocity[0][p.i]) * nx +
                   (grains.velocity[1][p.j] - grains.velocity[1][p.i]) * ny;
      Contact &c = add(p, k, gap);
      c.nx       = nx;
      c.ny       = ny;
      c.friction = material.friction;
      c.j        = p.j;
      if (!materials.law)
        c.bias_n = margins.bounce(all.bias[m], gap, start_vn, free_vn, material.restitution);
      else
        {
          const double vt = (grains.velocity[1][p.j] - grains.velocity[1][p.i]) * nx -
                            (grains.velocity[0][p.j] - grains.velocity[0][p.i]) * ny;
          add_state(material, {gap, start_vn, free_vn, std::abs(vt - (spin(p.i) + spin(p.j)))});
        }
      if (materials.rolls)
        {
          const double ri = grains.radius[p.i], rj = grains.radius[p.j], reduced = ri * rj / (ri + rj);
          add_rolling(p, reduced / ri, reduced / rj, 0., material.rolling);
        }
    };
    std::uint32_t dummy       = 0;
    const auto    select_wall = [&](const std::size_t k) {
      ContactPair &p = candidates.walls[k];
      const Disc  &v = free[p.i];
      ContactPoint point;
      if (v.inverse_mass == 0. ||
          !geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point))
        {
          wall_takes_part[k] = 0;
          p.rn = p.rt = p.rr = 0.;
          return;
        }
      const double free_vn = (point.vx - v.x) * point.nx + (point.vy - v.y) * point.ny;
      if (!(keep && wall_takes_part[k]) && point.gap >= alert_distance &&
          point.gap - alert_distance + h * free_vn >= 0.)
        {
          p.rn = p.rt = p.rr = 0.;
          return;
        }
      wall_takes_part[k]        = 1;
      const ContactMaterial &m  = materials.walls[p.j];
      const double           vx = point.vx - grains.velocity[0][p.i], vy = point.vy - grains.velocity[1][p.i];
      const double           start_vn = vx * point.nx + vy * point.ny;
      Contact               &c        = add(p, candidates.discs.size() + k, point.gap);
      c.nx                            = point.nx;
      c.ny                            = point.ny;
      c.bias_n                        = point.vx * point.nx + point.vy * point.ny;
      c.bias_t                        = point.vy * point.nx - point.vx * point.ny;
      c.friction                      = m.friction;
      c.j                             = bodies.n_discs() + dummy++ % ContactBodies::n_dummies;
      if (!materials.law)
        c.bias_n += margins.bounce(margins.bias(point.gap), point.gap, start_vn, free_vn, m.restitution);
      else
        add_state(m, {point.gap, start_vn, free_vn, std::abs(vy * point.nx - vx * point.ny - spin(p.i))});
      if (materials.rolls)
        add_rolling(p, 1., 0., grains.radius[p.i] * geometry.walls.segments()[p.j].spin, m.rolling);
    };

    if (problem.contacts.capacity() == 0)
      {
        problem.contacts.reserve(2 * problem.n_owned_discs); // about what a settled bed has
        number.reserve(2 * problem.n_owned_discs);
      }
    std::size_t  disc = 0, wall = 0;
    PairGeometry some;
    for (unsigned int colour = 0; colour < n_colours; ++colour)
      {
        for (; disc < candidates.discs.size() && candidates.discs[disc].colour == colour; ++disc)
          {
            const unsigned int m = disc % PairGeometry::most;
            if (m == 0)
              find_geometry(&candidates.discs[disc],
                            std::min<std::size_t>(PairGeometry::most, candidates.discs.size() - disc),
                            grains,
                            free,
                            geometry.periodicity,
                            margins,
                            some);
            select_disc(disc, some, m);
          }
        for (; wall < candidates.walls.size() && candidates.walls[wall].colour == colour; ++wall)
          select_wall(wall);
        problem.colour_begin.push_back(problem.contacts.size());
      }
    if (materials.law)
      ask(*materials.law, margins, problem);
    // Colours at the end that are empty on all ranks are none.
    std::size_t n_used = problem.n_colours();
    while (n_used > 0 && problem.colour_begin[n_used - 1] == problem.contacts.size())
      --n_used;
    problem.colour_begin.resize(max_over_ranks(problem.communicator, n_used) + 1);
  }

  /** Let the law change the coefficients; the contacts' biases are those of walls up to now. */
  void ContactActiveSet::ask(const ContactLaw &law, const ContactMargins &margins, ContactProblem &problem)
  {
    law.set_coefficients(states, coefficients);
    for (std::size_t k = 0; k < states.size(); ++k)
      {
        const ContactState &s        = states[k];
        problem.contacts[k].friction = coefficients[k].friction;
        problem.contacts[k].bias_n +=
          margins.bounce(margins.bias(s.gap), s.gap, s.start_vn, s.free_vn, coefficients[k].restitution);
        if (!problem.rolling.empty())
          problem.rolling[k].coefficient = coefficients[k].rolling;
      }
  }

  void ContactActiveSet::restart_from_impulses(const ContactCandidates &candidates)
  {
    disc_takes_part.assign(candidates.discs.size(), 0);
    wall_takes_part.assign(candidates.walls.size(), 0);
    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      disc_takes_part[k] = candidates.discs[k].rn > 0.;
    for (std::size_t k = 0; k < candidates.walls.size(); ++k)
      wall_takes_part[k] = candidates.walls[k].rn > 0.;
  }

  bool ContactActiveSet::add_violated(const grains::GrainArrays &grains,
                                      const ContactBodies       &bodies,
                                      const ContactGeometry     &geometry,
                                      const std::vector<Disc>   &velocity,
                                      const double               h,
                                      const ContactCandidates   &candidates)
  {
    bool found = false;
    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      if (!disc_takes_part[k])
        {
          const ContactPair &p  = candidates.discs[k];
          const Disc        &vi = velocity[p.i], &vj = velocity[p.j];
          double             dx = grains.position[0][p.j] - grains.position[0][p.i],
                 dy             = grains.position[1][p.j] - grains.position[1][p.i];
          geometry.periodicity.shorten(dx, dy);
          const double distance = std::sqrt(dx * dx + dy * dy);
          const double gap      = distance - (grains.radius[p.i] + grains.radius[p.j]);
          if (gap * distance + h * ((vj.x - vi.x) * dx + (vj.y - vi.y) * dy) < 0. &&
              bodies.free[p.i].inverse_mass + bodies.free[p.j].inverse_mass > 0.)
            {
              disc_takes_part[k] = 1;
              found              = true;
            }
        }
    for (std::size_t k = 0; k < candidates.walls.size(); ++k)
      if (!wall_takes_part[k])
        {
          const ContactPair &p = candidates.walls[k];
          const Disc        &v = velocity[p.i];
          ContactPoint       point;
          if (bodies.free[p.i].inverse_mass > 0. &&
              geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point) &&
              point.gap + h * ((point.vx - v.x) * point.nx + (point.vy - v.y) * point.ny) < 0.)
            {
              wall_takes_part[k] = 1;
              found              = true;
            }
        }
    return found;
  }

  double ContactActiveSet::take_impulses(const ContactProblem &problem, ContactCandidates &candidates) const
  {
    double            largest = 0.;
    const std::size_t n_discs = candidates.discs.size();
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact &c = problem.contacts[k];
        ContactPair   &p = number[k] < n_discs ? candidates.discs[number[k]] : candidates.walls[number[k] - n_discs];
        p.rn             = c.rn;
        p.rt             = c.rt;
        p.rr             = problem.rolling.empty() ? 0. : problem.rolling[k].impulse;
        largest          = std::max(largest, c.rn);
      }
    return largest;
  }

  bool ContactActiveSet::is_cold(const std::size_t n_discs, const ContactProblem &problem) const
  {
    const std::size_t closed = count_over_ranks(problem.communicator, n_closed),
                      warm   = count_over_ranks(problem.communicator, n_warm);
    // Of a bed at rest with known impulses, a third of the closed contacts carry none. And a small one needs no help.
    return n_discs >= 1000 && 2 * warm < closed && 2 * closed > n_discs;
  }

  void ContactActiveSet::measure_overlaps(const grains::GrainArrays &grains,
                                          const ContactGeometry     &geometry,
                                          const ContactProblem      &problem,
                                          const ContactCandidates   &candidates,
                                          double                    &mean,
                                          double                    &largest)
  {
    overlaps.resize(std::max(overlaps.size(), problem.contacts.size()));
    std::size_t n_overlaps = 0;
    largest                = 0.;
    double gaps[PairGeometry::most];
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact     &c = problem.contacts[k];
        const unsigned int m = k % PairGeometry::most;
        if (m == 0)
          find_gaps(&c,
                    std::min<std::size_t>(PairGeometry::most, problem.contacts.size() - k),
                    grains,
                    geometry.periodicity,
                    gaps);
        if (!problem.counts(c))
          continue;
        if (is_wall(k, candidates))
          {
            ContactPoint point;
            gaps[m] =
              geometry.walls.touch(
                pair(k, candidates).j, grains.position[0][c.i], grains.position[1][c.i], grains.radius[c.i], point)
                ? point.gap
                : 0.;
          }
        // Half of them overlap, nobody knows which: keep it, perhaps to be overwritten, rather than branch.
        overlaps[n_overlaps] = -gaps[m];
        n_overlaps += gaps[m] < 0.;
        largest = std::max(largest, -gaps[m]);
      }
    largest               = max_over_ranks(problem.communicator, largest);
    const std::size_t n   = count_over_ranks(problem.communicator, n_overlaps);
    const double      sum = sum_over_ranks<1>(problem.communicator, n_overlaps, n, [&](const std::size_t k) {
      return std::array<double, 1>{{overlaps[k]}};
    })[0];
    mean                  = n > 0 ? sum / n : 0.;
  }
} // namespace alluvium::contacts
