#include <alluvium/grains/contact_search.h>
#include <alluvium/grains/contact_solver.h>
#include <alluvium/grains/contact_stepper.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace alluvium::grains
{
  namespace
  {
    constexpr const char *default_solver = "accelerated Gauss-Seidel";
    constexpr std::size_t n_dummies = 16; // stand for walls; several, so that wall contacts in a row stay independent

    std::uint64_t key(const std::uint32_t a, const std::uint32_t b)
    {
      return (std::uint64_t(a) << 32) | b;
    }

    /** Colours contacts such that those of one colour share no disc: the sweeps then run without waiting for each
     * other. */
    class Colouring
    {
    public:
      void reset(const std::size_t n_discs) { used.assign(n_discs, 0); }

      unsigned int add(const std::uint32_t i)
      {
        const unsigned int colour = first_free(used[i]);
        used[i] |= std::uint64_t(1) << colour;
        return colour;
      }

      unsigned int add(const std::uint32_t i, const std::uint32_t j)
      {
        const unsigned int colour = first_free(used[i] | used[j]);
        used[i] |= std::uint64_t(1) << colour;
        used[j] |= std::uint64_t(1) << colour;
        return colour;
      }

      static constexpr unsigned int n_colours = 64;

    private:
      std::vector<std::uint64_t> used;

      static unsigned int first_free(const std::uint64_t mask)
      {
        unsigned int colour = 0;
        while (colour + 1 < n_colours && ((mask >> colour) & 1))
          ++colour;
        return colour;
      }
    };
  } // namespace


  class ContactStepper::Implementation
  {
  public:
    ContactSettings             settings;
    PluginChoice<ContactSolver> choice;
    WallGeometry                walls;
    std::vector<std::uint8_t>   touched;

    ContactReport advance(GrainArrays &grains, const GrainLoads &loads, double dt, std::array<double, 2> gravity);

    ContactArchive archive() const
    {
      ContactArchive result;
      result.dt = warm_dt;
      if (!pending.entries.empty())
        return pending;
      for (const ContactPair &p : candidates.discs)
        if (p.rn != 0. || p.rt != 0.)
          result.entries.push_back({searched_id[p.i], searched_id[p.j], false, p.rn, p.rt});
      for (const ContactPair &p : candidates.walls)
        if (p.rn != 0. || p.rt != 0.)
          result.entries.push_back({searched_id[p.i], ~p.j, true, p.rn, p.rt});
      return result;
    }

    void set_archive(ContactArchive archive)
    {
      candidates = {};
      searched_id.clear();
      pending  = std::move(archive);
      warm_dt  = pending.dt;
      searched = false;
    }

    void forget_search()
    {
      pending  = archive();
      searched = false;
    }

  private:
    /** A pair that takes part in the solve, before it becomes a Contact. */
    struct Active
    {
      ContactPair *pair;
      ContactPoint point;
      double       bias;
      unsigned int colour;
      bool         wall;
    };

    mutable std::unique_ptr<ContactSolver> own_solver;

    // The last contact search: what it found, and where the grains were.
    ContactCandidates    candidates;
    std::vector<GrainId> searched_id;
    std::vector<double>  searched_x, searched_y;
    double               searched_skin = 0.;
    bool                 searched      = false;
    ContactArchive       pending; // impulses that wait for a search
    double               warm_dt = 0.;

    // Scratch of a sub-step.
    ContactProblem            problem;
    std::vector<Disc>         start, free_velocity;
    std::vector<double>       inverse_mass, inverse_rotation;
    std::vector<Active>       active, active_sorted;
    std::vector<std::uint8_t> disc_pair_active, wall_pair_active;
    Colouring                 colouring;

    // Scratch of a step.
    std::vector<double>                px, py, sub_px, sub_py, sub_ps;
    std::vector<std::array<double, 2>> wall_impulse;
    double                             base_h = 0.; // length of an unhalved sub-step
    double                             d_min = 0., d_max = 0., mean_mass = 0., g = 0.;

    const ContactSolver &solver() const
    {
      if (!choice.name().empty())
        return choice.get();
      if (!own_solver)
        own_solver = Registry<ContactSolver>::entries().at(default_solver).create();
      return *own_solver;
    }

    void search(const GrainArrays &grains, double skin);
    /** Sum of the two largest entries of |displacement since the search|. */
    double largest_approach(const GrainArrays &grains) const;
    void   set_free_velocities(const GrainArrays &grains, const GrainLoads &loads, double h);
    void   activate(const GrainArrays &grains, double h, double delta, double margin, double push_out, bool keep);
    void   build_contacts();
    bool   add_violated(const GrainArrays &grains, double h);
    void   substep(GrainArrays &grains, const GrainLoads &loads, double h, unsigned int level, ContactReport &report);
  };


  void ContactStepper::Implementation::search(const GrainArrays &grains, const double skin)
  {
    if (pending.entries.empty())
      pending = archive();
    candidates    = find_candidates(grains, walls, skin);
    searched_id   = grains.id;
    searched_x    = grains.x;
    searched_y    = grains.y;
    searched_skin = skin;
    searched      = true;

    // Impulses survive the search: both lists are sorted by ids, one pass through each finds the common pairs.
    std::vector<std::pair<std::uint64_t, const ContactArchive::Entry *>> discs, segments;
    for (const auto &e : pending.entries)
      (e.wall ? segments : discs).emplace_back(key(e.a, e.wall ? ~e.b : e.b), &e);
    for (auto *list : {&discs, &segments})
      if (!std::is_sorted(list->begin(), list->end(), [](const auto &p, const auto &q) { return p.first < q.first; }))
        std::sort(list->begin(), list->end(), [](const auto &p, const auto &q) { return p.first < q.first; });
    const auto carry = [&](std::vector<ContactPair> &pairs, const auto &list, const bool wall) {
      auto it = list.begin();
      for (ContactPair &p : pairs)
        {
          const std::uint64_t k = key(grains.id[p.i], wall ? p.j : grains.id[p.j]);
          while (it != list.end() && it->first < k)
            ++it;
          if (it == list.end())
            break;
          if (it->first == k)
            {
              p.rn = it->second->rn;
              p.rt = it->second->rt;
            }
        }
    };
    carry(candidates.discs, discs, false);
    carry(candidates.walls, segments, true);
    pending.entries.clear();
  }

  double ContactStepper::Implementation::largest_approach(const GrainArrays &grains) const
  {
    double first = 0., second = 0.;
    for (std::size_t k = 0; k < grains.n(); ++k)
      {
        const double dx = grains.x[k] - searched_x[k], dy = grains.y[k] - searched_y[k], d = dx * dx + dy * dy;
        if (d > first)
          {
            second = first;
            first  = d;
          }
        else if (d > second)
          second = d;
      }
    return std::sqrt(first) + std::sqrt(second);
  }

  void ContactStepper::Implementation::set_free_velocities(const GrainArrays &grains,
                                                           const GrainLoads  &loads,
                                                           const double       h)
  {
    const std::size_t n = grains.n();
    start.resize(n);
    free_velocity.resize(n + n_dummies);
    inverse_mass.resize(n + n_dummies);
    inverse_rotation.resize(n + n_dummies);
    problem.n_discs = problem.n_owned_discs = n;
    for (std::size_t k = 0; k < n; ++k)
      {
        start[k] = {grains.vx[k], grains.vy[k], grains.radius[k] * grains.omega[k]};
        if (std::isinf(grains.mass[k]))
          {
            free_velocity[k] = start[k];
            inverse_mass[k] = inverse_rotation[k] = 0.;
            continue;
          }
        const double m = grains.mass[k], m_e = m + h * loads.drag[k];
        inverse_mass[k]     = 1. / m_e;
        inverse_rotation[k] = settings.rotation ? 1. / disc_inertia(m, 1.) : 0.;
        free_velocity[k]    = {(m * start[k].x + h * loads.fx[k]) * inverse_mass[k],
                               (m * start[k].y + h * loads.fy[k]) * inverse_mass[k],
                               start[k].s,
                               inverse_mass[k],
                               inverse_rotation[k]};
      }
    for (std::size_t k = n; k < n + n_dummies; ++k)
      {
        free_velocity[k] = {};
        inverse_mass[k] = inverse_rotation[k] = 0.;
      }
  }

  void ContactStepper::Implementation::activate(const GrainArrays &grains,
                                                const double       h,
                                                const double       delta,
                                                const double       margin,
                                                const double       push_out,
                                                const bool         keep)
  {
    active.clear();
    if (!keep)
      {
        disc_pair_active.assign(candidates.discs.size(), 0);
        wall_pair_active.assign(candidates.walls.size(), 0);
      }
    colouring.reset(grains.n());

    // v_n + bias >= 0: gaps within delta count as closed, so that a bed at rest does not chatter; overlaps open at
    // bounded speed.
    const auto bias = [&](const double gap, const double vn_start, const double vn_free) {
      double b = 0.;
      if (gap > delta)
        b = (gap - delta) / h;
      else if (gap < -delta)
        b = std::max(settings.correction * (gap + delta) / base_h, -push_out);
      if (settings.restitution > 0. && vn_start < -settings.threshold_velocity && gap + h * vn_free < delta)
        b = gap > 0. ? settings.restitution * vn_start : std::min(b, settings.restitution * vn_start);
      return b;
    };

    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      {
        ContactPair &p  = candidates.discs[k];
        const Disc  &vi = free_velocity[p.i], &vj = free_velocity[p.j];
        const double dx = grains.x[p.j] - grains.x[p.i], dy = grains.y[p.j] - grains.y[p.i];
        const double distance = std::sqrt(dx * dx + dy * dy),
                     gap      = distance - (grains.radius[p.i] + grains.radius[p.j]);
        const double approach = (vj.x - vi.x) * dx + (vj.y - vi.y) * dy;
        if (!(keep && disc_pair_active[k]) && gap >= margin && (gap - margin) * distance + h * approach >= 0.)
          {
            p.rn = p.rt = 0.;
            continue;
          }
        if (inverse_mass[p.i] + inverse_mass[p.j] == 0.)
          continue;
        disc_pair_active[k] = 1;
        const double over   = distance > 0. ? 1. / distance : 0.;
        const double nx = distance > 0. ? dx * over : 1., ny = dy * over;
        double       vn_start = 0.;
        if (settings.restitution > 0.)
          vn_start = (start[p.j].x - start[p.i].x) * nx + (start[p.j].y - start[p.i].y) * ny;
        active.push_back({&p, {nx, ny, gap}, bias(gap, vn_start, approach * over), colouring.add(p.i, p.j), false});
      }
    for (std::size_t k = 0; k < candidates.walls.size(); ++k)
      {
        ContactPair &p = candidates.walls[k];
        const Disc  &v = free_velocity[p.i];
        const auto  &w = walls.segments()[p.j].velocity;
        ContactPoint point;
        if (inverse_mass[p.i] == 0. || !walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point))
          {
            wall_pair_active[k] = 0;
            p.rn = p.rt = 0.;
            continue;
          }
        const double vn_free = (w[0] - v.x) * point.nx + (w[1] - v.y) * point.ny;
        if (!(keep && wall_pair_active[k]) && point.gap >= margin && point.gap - margin + h * vn_free >= 0.)
          {
            p.rn = p.rt = 0.;
            continue;
          }
        wall_pair_active[k]   = 1;
        const double vn_start = (w[0] - start[p.i].x) * point.nx + (w[1] - start[p.i].y) * point.ny;
        active.push_back({&p, point, bias(point.gap, vn_start, vn_free), colouring.add(p.i), true});
      }
  }

  void ContactStepper::Implementation::build_contacts()
  {
    std::array<std::uint32_t, Colouring::n_colours + 1> begin{};
    for (const Active &a : active)
      ++begin[a.colour + 1];
    for (unsigned int c = 0; c < Colouring::n_colours; ++c)
      begin[c + 1] += begin[c];
    active_sorted.resize(active.size());
    for (const Active &a : active)
      active_sorted[begin[a.colour]++] = a;
    // begin[c] has become the end of colour c
    problem.colour_begin.assign(1, 0);
    problem.colour_begin.insert(problem.colour_begin.end(), begin.begin(), begin.begin() + Colouring::n_colours);
    while (problem.n_colours() > 0 && problem.colour_begin.end()[-2] == active.size())
      problem.colour_begin.pop_back();

    const std::size_t n_discs = start.size();
    problem.contacts.resize(active.size());
    unsigned int dummy = 0;
    for (std::size_t k = 0; k < active.size(); ++k)
      {
        const Active &a = active_sorted[k];
        Contact      &c = problem.contacts[k];
        c.i             = a.pair->i;
        c.j             = a.wall ? n_discs + (dummy++ % n_dummies) : a.pair->j;
        c.nx            = a.point.nx;
        c.ny            = a.point.ny;
        c.bias_n        = a.bias;
        c.bias_t        = 0.;
        c.rn            = a.pair->rn;
        c.rt            = a.pair->rt;
        if (a.wall)
          {
            const auto &w = walls.segments()[a.pair->j].velocity;
            c.bias_n += w[0] * c.nx + w[1] * c.ny;
            c.bias_t = w[1] * c.nx - w[0] * c.ny;
          }
        c.friction = a.wall ? settings.wall_friction : settings.friction;
      }
  }

  bool ContactStepper::Implementation::add_violated(const GrainArrays &grains, const double h)
  {
    bool found = false;
    for (std::size_t k = 0; k < candidates.discs.size(); ++k)
      if (!disc_pair_active[k])
        {
          const ContactPair &p  = candidates.discs[k];
          const Disc        &vi = problem.discs[p.i], &vj = problem.discs[p.j];
          const double       dx = grains.x[p.j] - grains.x[p.i], dy = grains.y[p.j] - grains.y[p.i];
          const double       distance = std::sqrt(dx * dx + dy * dy);
          const double       gap      = distance - (grains.radius[p.i] + grains.radius[p.j]);
          if (gap * distance + h * ((vj.x - vi.x) * dx + (vj.y - vi.y) * dy) < 0. &&
              inverse_mass[p.i] + inverse_mass[p.j] > 0.)
            {
              disc_pair_active[k] = 1;
              found               = true;
            }
        }
    for (std::size_t k = 0; k < candidates.walls.size(); ++k)
      if (!wall_pair_active[k])
        {
          const ContactPair &p = candidates.walls[k];
          const Disc        &v = problem.discs[p.i];
          const auto        &w = walls.segments()[p.j].velocity;
          ContactPoint       point;
          if (inverse_mass[p.i] > 0. && walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point) &&
              point.gap + h * ((w[0] - v.x) * point.nx + (w[1] - v.y) * point.ny) < 0.)
            {
              wall_pair_active[k] = 1;
              found               = true;
            }
        }
    return found;
  }

  void ContactStepper::Implementation::substep(
    GrainArrays &grains, const GrainLoads &loads, const double h, const unsigned int level, ContactReport &report)
  {
    const std::size_t n = grains.n();
    set_free_velocities(grains, loads, h);
    const auto top_two = [&](const std::vector<Disc> &v) {
      double first = 0., second = 0.;
      for (std::size_t k = 0; k < n; ++k)
        {
          const double s = v[k].x * v[k].x + v[k].y * v[k].y;
          if (s > first)
            {
              second = first;
              first  = s;
            }
          else if (s > second)
            second = s;
        }
      return std::array<double, 2>{{std::sqrt(first), std::sqrt(second)}};
    };
    double wall_speed = 0.;
    for (const WallSegment &w : walls.segments())
      wall_speed = std::max(wall_speed, std::hypot(w.velocity[0], w.velocity[1]));

    // Scales: what gravity does in the sub-step; without gravity, what moves.
    const auto speed          = top_two(start);
    double     velocity_scale = g * h;
    if (!(velocity_scale > 0.))
      velocity_scale = std::max({speed[0], top_two(free_velocity)[0], wall_speed});
    if (!(velocity_scale > 0.))
      velocity_scale = 1e-3 * d_min / h;
    const double velocity_unit = g > 0. ? std::sqrt(g * d_min) : velocity_scale;
    const double delta         = std::min(settings.dead_zone * base_h * velocity_unit, 1e-3 * d_min);
    const double push_out      = settings.push_out * velocity_unit;
    double       mean_square   = 0.;
    for (const Disc &v : start)
      mean_square += (v.x * v.x + v.y * v.y) / n;
    // Pairs this near take part from the start: the faster the grains, the more likely a solution closes a gap. Fewer
    // rounds then.
    const double margin   = std::max({2. * delta, 2e-3 * d_min, std::min(h * std::sqrt(mean_square), 0.1 * d_min)});
    problem.impulse_scale = mean_mass * velocity_scale;

    // Warm impulses of a sub-step of another length.
    if (warm_dt > 0. && warm_dt != h)
      {
        const double scale = h / warm_dt;
        for (auto *list : {&candidates.discs, &candidates.walls})
          for (ContactPair &p : *list)
            {
              p.rn *= scale;
              p.rt *= scale;
            }
        for (auto &e : pending.entries)
          {
            e.rn *= scale;
            e.rt *= scale;
          }
      }
    warm_dt = h;

    const double typical = settings.skin * d_max;
    const double reach   = speed[0] + speed[1] + wall_speed + 2. * g * h;
    bool         fresh   = false;
    if (!searched || searched_id != grains.id || searched_skin - largest_approach(grains) < margin + h * reach)
      {
        if (searched && searched_id != grains.id)
          forget_search();
        search(grains, std::max(typical, 1.2 * h * reach + margin));
        fresh = true;
      }
    double left = searched_skin - (fresh ? 0. : largest_approach(grains));

    ContactTolerance      tolerance{settings.residual_tolerance,
                               settings.violation_tolerance,
                               settings.loose,
                               settings.patience,
                               settings.max_sweeps};
    ContactSolution       solution;
    std::array<double, 2> end_speed{};
    bool                  too_far = false, keep = false;
    // Solve with the contacts that are close or closing; if the solution makes others close, add them and solve on.
    for (unsigned int round = 0;; ++round)
      {
        activate(grains, h, delta, margin, push_out, keep);
        // A cold bed is not on the move, however many sweeps it takes.
        tolerance.patience = std::any_of(active.begin(), active.end(), [](const Active &a) { return a.pair->rn > 0.; })
                               ? settings.patience
                               : settings.max_sweeps;
        build_contacts();
        problem.discs = free_velocity;
        solution      = solver().solve(problem, tolerance);
        report.n_sweeps += solution.sweeps;
        report.n_updates += static_cast<unsigned long long>(solution.sweeps) * problem.contacts.size();
        for (std::size_t k = 0; k < problem.contacts.size(); ++k)
          {
            active_sorted[k].pair->rn = problem.contacts[k].rn;
            active_sorted[k].pair->rt = problem.contacts[k].rt;
          }
        if (solution.converged && solution.residual > settings.residual_tolerance)
          ++report.n_loose;
        end_speed = top_two(problem.discs);
        if (!std::isfinite(end_speed[0]))
          throw std::runtime_error("A grain velocity is not a finite number after the contact solve.");
        too_far = h * end_speed[0] > 2. * settings.max_move * d_min;
        if (!solution.converged || too_far)
          break;
        if (h * (end_speed[0] + end_speed[1] + wall_speed) > left)
          {
            forget_search();
            search(grains, 1.2 * h * (end_speed[0] + end_speed[1] + wall_speed));
            left = searched_skin;
            keep = false;
            disc_pair_active.assign(candidates.discs.size(), 0);
            wall_pair_active.assign(candidates.walls.size(), 0);
            for (std::size_t k = 0; k < candidates.discs.size(); ++k)
              disc_pair_active[k] = candidates.discs[k].rn > 0.;
            for (std::size_t k = 0; k < candidates.walls.size(); ++k)
              wall_pair_active[k] = candidates.walls[k].rn > 0.;
            keep = true;
            add_violated(grains, h);
            continue;
          }
        if (!add_violated(grains, h))
          break;
        keep = true;
      }

    if ((!solution.converged || too_far) && level < settings.max_halvings)
      {
        ++report.n_halvings;
        for (int half = 0; half < 2; ++half)
          substep(grains, loads, 0.5 * h, level + 1, report);
        return;
      }
    if (!solution.converged)
      ++report.n_unconverged;

    // Final velocities from the impulses themselves, so that momentum is balanced to round-off.
    sub_px.assign(n + n_dummies, 0.);
    sub_py.assign(n + n_dummies, 0.);
    sub_ps.assign(n + n_dummies, 0.);
    report.n_contacts = 0;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact &c = problem.contacts[k];
        if (c.rn == 0. && c.rt == 0.)
          continue;
        ++report.n_contacts;
        const double ix = c.rn * c.nx - c.rt * c.ny, iy = c.rn * c.ny + c.rt * c.nx;
        sub_px[c.i] -= ix;
        sub_py[c.i] -= iy;
        sub_ps[c.i] -= c.rt;
        sub_px[c.j] += ix;
        sub_py[c.j] += iy;
        sub_ps[c.j] -= c.rt;
        touched[c.i] = 1;
        if (active_sorted[k].wall)
          {
            wall_impulse[active_sorted[k].pair->j][0] += ix;
            wall_impulse[active_sorted[k].pair->j][1] += iy;
          }
        else
          touched[c.j] = 1;
      }
    for (std::size_t k = 0; k < n; ++k)
      {
        grains.vx[k] = free_velocity[k].x + inverse_mass[k] * sub_px[k];
        grains.vy[k] = free_velocity[k].y + inverse_mass[k] * sub_py[k];
        if (settings.rotation)
          grains.omega[k] += inverse_rotation[k] * sub_ps[k] / grains.radius[k];
        grains.x[k] += h * grains.vx[k];
        grains.y[k] += h * grains.vy[k];
        px[k] += sub_px[k];
        py[k] += sub_py[k];
      }
    walls.move(h);
    if (wall_speed > 0.)
      searched_skin -= h * wall_speed;
    ++report.n_substeps;
    report.residual     = std::max(report.residual, solution.residual);
    report.violation    = std::max(report.violation, solution.violation);
    report.max_velocity = end_speed[0];
  }

  ContactReport ContactStepper::Implementation::advance(GrainArrays                &grains,
                                                        const GrainLoads           &loads,
                                                        const double                dt,
                                                        const std::array<double, 2> gravity)
  {
    ContactReport     report;
    const std::size_t n = grains.n();
    if (loads.fx.size() != n || loads.fy.size() != n || loads.drag.size() != n)
      throw std::logic_error("ContactStepper::advance: the loads have another size than the grains.");
    for (const WallSegment &w : walls.segments())
      report.wall_force[w.name] = {{0., 0.}};
    touched.assign(n, 0);
    if (n == 0 || !(dt > 0.))
      return report;

    const auto [r_min, r_max] = std::minmax_element(grains.radius.begin(), grains.radius.end());
    d_min                     = 2. * *r_min;
    d_max                     = 2. * *r_max;
    g                         = std::hypot(gravity[0], gravity[1]);
    double sum                = 0.;
    for (const double m : grains.mass)
      sum += 1. / m;
    mean_mass =
      sum > 0. ? n / sum : 1.; // harmonic: the light grains decide, and fixed ones (infinite mass) do not count

    px.assign(n, 0.);
    py.assign(n, 0.);
    wall_impulse.assign(walls.segments().size(), {{0., 0.}});

    // Sub-steps from the largest speed, now or at the end if last step's contact forces go on; substep() halves if that
    // is wrong.
    double speed = 0.;
    for (std::size_t k = 0; k < n; ++k)
      {
        const double m  = grains.mass[k];
        double       vx = grains.vx[k], vy = grains.vy[k];
        speed = std::max(speed, vx * vx + vy * vy);
        if (!std::isinf(m))
          {
            vx    = (m * vx + dt * (loads.fx[k] + grains.fcx[k])) / (m + dt * loads.drag[k]);
            vy    = (m * vy + dt * (loads.fy[k] + grains.fcy[k])) / (m + dt * loads.drag[k]);
            speed = std::max(speed, vx * vx + vy * vy);
          }
        if (!std::isfinite(vx * vx + vy * vy + grains.x[k] + grains.y[k]))
          throw std::runtime_error("The position, the velocity or the load of grain " + std::to_string(grains.id[k]) +
                                   " is not a finite number.");
      }
    const double n_substeps = std::ceil(dt * std::sqrt(speed) / (settings.max_move * d_min));
    if (n_substeps > 1e6)
      throw std::runtime_error("A grain moves at " + std::to_string(std::sqrt(speed)) +
                               " m/s: one step would need more than a million contact sub-steps.");
    const unsigned int steps = std::max(1., n_substeps);
    base_h                   = dt / steps;
    for (unsigned int s = 0; s < steps; ++s)
      substep(grains, loads, base_h, 0, report);

    for (std::size_t k = 0; k < n; ++k)
      {
        grains.fcx[k] = px[k] / dt;
        grains.fcy[k] = py[k] / dt;
      }
    for (std::size_t k = 0; k < wall_impulse.size(); ++k)
      {
        auto &force = report.wall_force[walls.segments()[k].name];
        force[0] += wall_impulse[k][0] / dt;
        force[1] += wall_impulse[k][1] / dt;
      }
    std::size_t overlaps = 0;
    for (const Active &a : active_sorted)
      {
        const ContactPair &p   = *a.pair;
        double             gap = 0.;
        ContactPoint       point;
        if (!a.wall)
          {
            const double dx = grains.x[p.j] - grains.x[p.i], dy = grains.y[p.j] - grains.y[p.i];
            gap = std::sqrt(dx * dx + dy * dy) - (grains.radius[p.i] + grains.radius[p.j]);
          }
        else if (walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point))
          gap = point.gap;
        if (gap < 0.)
          {
            ++overlaps;
            report.mean_penetration -= gap;
            report.max_penetration = std::max(report.max_penetration, -gap);
          }
      }
    if (overlaps > 0)
      report.mean_penetration /= overlaps;
    return report;
  }


  ContactStepper::ContactStepper()
    : implementation(std::make_unique<Implementation>())
  {}

  ContactStepper::~ContactStepper() = default;

  void ContactStepper::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    ContactSettings &s = implementation->settings;
    prm.add_parameter("Friction coefficient", s.friction, "Coulomb friction between grains [-].", Double(0.));
    prm.add_parameter(
      "Wall friction coefficient", s.wall_friction, "Coulomb friction between grains and walls [-].", Double(0.));
    prm.add_parameter("Restitution",
                      s.restitution,
                      "Newton's coefficient of restitution [-]: 0, an impact ends the approach; 1, it turns it around.",
                      Double(0., 1.));
    prm.add_parameter("Restitution threshold velocity",
                      s.threshold_velocity,
                      "Impacts slower than this do not bounce, so that grains come to rest [m/s].",
                      Double(0.));
    prm.add_parameter("Grains rotate", s.rotation, "If false, grains never spin, as if they were blocks.");
    prm.add_parameter(
      "Residual tolerance",
      s.residual_tolerance,
      "How far a contact impulse may be from its law, root mean square over all contacts, over the root mean "
      "square impulse or, if larger, that of the weight of one grain in a sub-step [-]. With much more than 1e-5 the "
      "floor of a bed no longer carries all of its weight.",
      Double(0.));
    prm.add_parameter("Largest violation", s.violation_tolerance, "The same for the worst contact [-].", Double(0.));
    prm.add_parameter(
      "Patience",
      s.patience,
      "After this many sweeps the grains are taken to be on the move, and the looser tolerance will do.",
      Integer(1));
    prm.add_parameter(
      "Loose factor",
      s.loose,
      "How much larger the residual tolerance and the largest violation are after that [-]. 1: never looser.",
      Double(1.));
    prm.add_parameter("Largest number of sweeps",
                      s.max_sweeps,
                      "A sub-step that is not solved after this many sweeps is taken as two halves.",
                      Integer(1));
    prm.add_parameter(
      "Largest number of halvings",
      s.max_halvings,
      "How often a sub-step may be halved before its best solution is taken and reported as unconverged.",
      Integer(0, 20));
    prm.add_parameter(
      "Largest move per sub-step",
      s.max_move,
      "The fastest grain sets the sub-step: it moves at most by this fraction of the smallest diameter [-].",
      Double(1e-6, 1.));
    prm.add_parameter(
      "Dead zone",
      s.dead_zone,
      "Gaps and overlaps below this times dt sqrt(g d) count as closed [-], so that a bed at rest does not "
      "chatter: 1e-5 d at dt = 1e-4 s, 1e-4 d at 1e-3 s for sand of 0.2 mm. Never more than 1e-3 d.",
      Double(0.));
    prm.add_parameter(
      "Overlap correction",
      s.correction,
      "The part of an overlap that is opened in one sub-step [-]. Small values are gentle; an overlap is an error of "
      "the solver or of the initial state, and opening it costs spurious velocity.",
      Double(0., 1.));
    prm.add_parameter(
      "Push-out speed",
      s.push_out,
      "Overlaps that are there from the start open at most at this times sqrt(g d) [-], so that they do not explode.",
      Double(0.));
    prm.add_parameter(
      "Search skin",
      s.skin,
      "Pairs nearer than this fraction of the largest diameter are remembered between contact searches [-]. Only "
      "costs time, changes no result.",
      Double(1e-3));
    implementation->choice.add_parameters(
      prm, "Contact solver", default_solver, "How the contact problem of a sub-step is solved.");
  }

  ContactSettings &ContactStepper::settings()
  {
    return implementation->settings;
  }

  void ContactStepper::set_walls(std::vector<WallSegment> walls)
  {
    implementation->walls.set(std::move(walls));
    implementation->forget_search();
  }

  const std::vector<WallSegment> &ContactStepper::walls() const
  {
    return implementation->walls.segments();
  }

  ContactReport ContactStepper::advance(GrainArrays                &grains,
                                        const GrainLoads           &loads,
                                        const double                dt,
                                        const std::array<double, 2> gravity)
  {
    return implementation->advance(grains, loads, dt, gravity);
  }

  const std::vector<std::uint8_t> &ContactStepper::touched() const
  {
    return implementation->touched;
  }

  ContactArchive ContactStepper::archive() const
  {
    return implementation->archive();
  }

  void ContactStepper::set_archive(ContactArchive archive)
  {
    implementation->set_archive(std::move(archive));
  }
} // namespace alluvium::grains
