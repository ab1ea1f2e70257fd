#include <alluvium/grains/contact_active_set.h>
#include <alluvium/grains/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  void ContactActiveSet::select(const GrainArrays      &grains,
                                const ContactBodies    &bodies,
                                const ContactGeometry  &geometry,
                                const ContactMaterials &materials,
                                const ContactMargins   &margins,
                                const bool              keep,
                                ContactCandidates      &candidates)
  {
    const double h = margins.h, delta = margins.delta, nearness = margins.nearness;
    active.clear();
    if (!keep)
      {
        disc_takes_part.assign(candidates.discs.size(), 0);
        wall_takes_part.assign(candidates.walls.size(), 0);
      }

    // v_n + bias >= 0: gaps within delta count as closed, so that a bed at rest does not chatter; overlaps open at
    // bounded speed.
    const auto bias = [&](const double gap, const double vn_start, const double vn_free, const double restitution) {
      double b = 0.;
      if (gap > delta)
        b = (gap - delta) / h;
      else if (gap < -delta && !margins.gentle)
        b = std::max(margins.correction * (gap + delta) / margins.base_h, -margins.push_out);
      if (restitution > 0. && !margins.gentle && vn_start < -margins.threshold && gap + h * vn_free < delta)
        b = gap > 0. ? restitution * vn_start : std::min(b, restitution * vn_start);
      return b;
    };

    const auto &start = bodies.start, &free = bodies.free;
    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      {
        ContactPair &p  = candidates.discs[k];
        const Disc  &vi = free[p.i], &vj = free[p.j];
        double       dx = grains.x[p.j] - grains.x[p.i], dy = grains.y[p.j] - grains.y[p.i];
        geometry.periodicity.shorten(dx, dy);
        const double distance = std::sqrt(dx * dx + dy * dy),
                     gap      = distance - (grains.radius[p.i] + grains.radius[p.j]);
        const double approach = (vj.x - vi.x) * dx + (vj.y - vi.y) * dy;
        if (!(keep && disc_takes_part[k]) && gap >= nearness && (gap - nearness) * distance + h * approach >= 0.)
          {
            p.rn = p.rt = p.rr = 0.;
            continue;
          }
        if (bodies.free[p.i].inverse_mass + bodies.free[p.j].inverse_mass == 0.)
          continue;
        disc_takes_part[k] = 1;
        const double over  = distance > 0. ? 1. / distance : 0.;
        const double nx = distance > 0. ? dx * over : 1., ny = dy * over;
        double       vn_start = 0.;
        if (materials.grains.restitution > 0.)
          vn_start = (start[p.j].x - start[p.i].x) * nx + (start[p.j].y - start[p.i].y) * ny;
        active.push_back(
          {&p, {nx, ny, gap}, bias(gap, vn_start, approach * over, materials.grains.restitution), false});
      }
    for (std::size_t k = 0; k < candidates.walls.size(); ++k)
      {
        ContactPair &p = candidates.walls[k];
        const Disc  &v = free[p.i];
        ContactPoint point;
        if (bodies.free[p.i].inverse_mass == 0. ||
            !geometry.walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point))
          {
            wall_takes_part[k] = 0;
            p.rn = p.rt = p.rr = 0.;
            continue;
          }
        const double vn_free = (point.vx - v.x) * point.nx + (point.vy - v.y) * point.ny;
        if (!(keep && wall_takes_part[k]) && point.gap >= nearness && point.gap - nearness + h * vn_free >= 0.)
          {
            p.rn = p.rt = p.rr = 0.;
            continue;
          }
        wall_takes_part[k]    = 1;
        const double vn_start = (point.vx - start[p.i].x) * point.nx + (point.vy - start[p.i].y) * point.ny;
        active.push_back({&p, point, bias(point.gap, vn_start, vn_free, materials.walls[p.j].restitution), true});
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

  bool ContactActiveSet::add_violated(const GrainArrays       &grains,
                                      const ContactBodies     &bodies,
                                      const ContactGeometry   &geometry,
                                      const std::vector<Disc> &velocity,
                                      const double             h,
                                      const ContactCandidates &candidates)
  {
    bool found = false;
    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      if (!disc_takes_part[k])
        {
          const ContactPair &p  = candidates.discs[k];
          const Disc        &vi = velocity[p.i], &vj = velocity[p.j];
          const double       dx = grains.x[p.j] - grains.x[p.i], dy = grains.y[p.j] - grains.y[p.i];
          const double       distance = std::sqrt(dx * dx + dy * dy);
          const double       gap      = distance - (grains.radius[p.i] + grains.radius[p.j]);
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
              geometry.walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point) &&
              point.gap + h * ((point.vx - v.x) * point.nx + (point.vy - v.y) * point.ny) < 0.)
            {
              wall_takes_part[k] = 1;
              found              = true;
            }
        }
    return found;
  }

  void ContactActiveSet::build(const unsigned int      n_colours,
                               const GrainArrays      &grains,
                               const ContactBodies    &bodies,
                               const ContactGeometry  &geometry,
                               const ContactMaterials &materials,
                               ContactProblem         &problem)
  {
    std::vector<std::uint32_t> begin(n_colours + 1, 0);
    for (const Active &a : active)
      ++begin[a.pair->colour + 1];
    for (unsigned int c = 0; c < n_colours; ++c)
      begin[c + 1] += begin[c];
    sorted.resize(active.size());
    for (const Active &a : active)
      sorted[begin[a.pair->colour]++] = a;

    // begin[c] has become the end of colour c
    problem.colour_begin.assign(1, 0);
    problem.colour_begin.insert(problem.colour_begin.end(), begin.begin(), begin.end() - 1);
    // Colours at the end that are empty on all ranks are none.
    std::size_t n_used = problem.n_colours();
    while (n_used > 0 && problem.colour_begin[n_used - 1] == active.size())
      --n_used;
    problem.colour_begin.resize(max_over_ranks(problem.communicator, n_used) + 1);

    problem.contacts.resize(active.size());
    problem.rolling.resize(materials.rolls ? active.size() : 0);
    unsigned int dummy = 0;
    for (std::size_t k = 0; k < active.size(); ++k)
      {
        const Active &a = sorted[k];
        Contact      &c = problem.contacts[k];
        c.i             = a.pair->i;
        c.j             = a.wall ? bodies.n_discs() + (dummy++ % ContactBodies::n_dummies) : a.pair->j;
        c.nx            = a.point.nx;
        c.ny            = a.point.ny;
        c.bias_n        = a.bias;
        c.bias_t        = 0.;
        c.rn            = a.pair->rn;
        c.rt            = a.pair->rt;
        if (a.wall)
          {
            c.bias_n += a.point.vx * c.nx + a.point.vy * c.ny;
            c.bias_t = a.point.vy * c.nx - a.point.vx * c.ny;
          }
        const ContactMaterial &material = a.wall ? materials.walls[a.pair->j] : materials.grains;
        c.friction                      = material.friction;
        if (materials.rolls)
          {
            const double ri = grains.radius[c.i], rj = a.wall ? 0. : grains.radius[c.j];
            const double reduced = a.wall ? ri : ri * rj / (ri + rj);
            problem.rolling[k]   = {a.pair->rr,
                                    a.pair->rr,
                                    reduced / ri,
                                  a.wall ? 0. : reduced / rj,
                                  a.wall ? reduced * geometry.walls.segments()[a.pair->j].spin : 0.,
                                    material.rolling};
          }
      }
  }

  void ContactActiveSet::take_impulses(const ContactProblem &problem)
  {
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        sorted[k].pair->rn = problem.contacts[k].rn;
        sorted[k].pair->rt = problem.contacts[k].rt;
        sorted[k].pair->rr = problem.rolling.empty() ? 0. : problem.rolling[k].impulse;
      }
  }

  bool ContactActiveSet::is_cold(const double delta, const std::size_t n_discs, const ContactProblem &problem) const
  {
    std::size_t closed = 0, warm = 0;
    for (const Active &a : active)
      if (a.point.gap <= delta && a.pair->i < problem.n_owned_discs)
        {
          ++closed;
          warm += a.pair->rn > 0.;
        }
    closed = count_over_ranks(problem.communicator, closed);
    warm   = count_over_ranks(problem.communicator, warm);
    // Of a bed at rest with known impulses, a third of the closed contacts carry none. And a small one needs no help.
    return n_discs >= 1000 && 2 * warm < closed && 2 * closed > n_discs;
  }

  void ContactActiveSet::measure_overlaps(const GrainArrays     &grains,
                                          const ContactGeometry &geometry,
                                          const ContactProblem  &problem,
                                          double                &mean,
                                          double                &largest) const
  {
    std::vector<double> overlaps;
    largest = 0.;
    for (std::size_t k = 0; k < sorted.size(); ++k)
      {
        const ContactPair &p   = *sorted[k].pair;
        double             gap = 0.;
        ContactPoint       point;
        if (!problem.counts(problem.contacts[k]))
          continue;
        if (!sorted[k].wall)
          gap = touch(grains, geometry.periodicity, p.i, p.j).gap;
        else if (geometry.walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point))
          gap = point.gap;
        if (gap < 0.)
          {
            overlaps.push_back(-gap);
            largest = std::max(largest, -gap);
          }
      }
    largest               = max_over_ranks(problem.communicator, largest);
    const std::size_t n   = count_over_ranks(problem.communicator, overlaps.size());
    const double      sum = sum_over_ranks<1>(problem.communicator, overlaps.size(), n, [&](const std::size_t k) {
      return std::array<double, 1>{{overlaps[k]}};
    })[0];
    mean                  = n > 0 ? sum / n : 0.;
  }
} // namespace alluvium::grains
