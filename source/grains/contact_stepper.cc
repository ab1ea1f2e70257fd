#include <alluvium/grains/cohesion.h>
#include <alluvium/grains/cold_start.h>
#include <alluvium/grains/contact_active_set.h>
#include <alluvium/grains/contact_bodies.h>
#include <alluvium/grains/contact_bonds.h>
#include <alluvium/grains/contact_material.h>
#include <alluvium/grains/contact_neighbours.h>
#include <alluvium/grains/contact_plausibility.h>
#include <alluvium/grains/contact_reductions.h>
#include <alluvium/grains/contact_search.h>
#include <alluvium/grains/contact_share.h>
#include <alluvium/grains/contact_solver.h>
#include <alluvium/grains/contact_stepper.h>
#include <alluvium/grains/rest.h>
#include <alluvium/grains/soft_spheres.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace alluvium::grains
{
  namespace
  {
    constexpr const char *default_solver = "accelerated Gauss-Seidel";
  } // namespace


  class ContactStepper::Implementation
  {
  public:
    ContactSettings             settings;
    std::string                 model = "non-smooth";
    SoftSpheres                 soft_spheres;
    PluginChoice<ContactSolver> choice;
    PluginChoice<Cohesion>      cohesion_choice;
    ContactGeometry             geometry;
    ContactNeighbours           neighbours;
    Rest                        rest;
    std::vector<std::uint8_t>   touched;

    std::unique_ptr<ContactShare> share; // none on one rank

    ContactReport advance(GrainArrays &grains, const GrainLoads &loads, double dt, std::array<double, 2> gravity);

    std::vector<ContactForce> forces(const GrainArrays &grains) const;

    void set_communicator(const MPI_Comm communicator)
    {
      set_shared(false);
      share = std::make_unique<ContactShare>(communicator);
    }

    const Cohesion *acting_cohesion() const
    {
      return !cohesion_choice.name().empty() && cohesion_choice.get().acts() ? &cohesion_choice.get() : nullptr;
    }

    /**
     * Whether ranks share the work on @p n grains. Cohesion and soft spheres sum forces pair by pair in the order of
     * all grains, so there every rank does all.
     */
    bool shares(const std::size_t n) const
    {
      return share && share->n_ranks() > 1 && model == "non-smooth" && acting_cohesion() == nullptr &&
             n >= settings.least_share * share->n_ranks();
    }

    ContactArchive archive() const { return shared ? share->collect(neighbours.archive()) : neighbours.archive(); }

  private:
    /** What a sub-step came to. */
    struct Outcome
    {
      ContactSolution solution;
      double          speed   = 0.;    // of the fastest grain [m/s]
      bool            too_far = false; // it moves farther than it may
    };

    mutable std::unique_ptr<ContactSolver> own_solver;

    // Scratch of a sub-step.
    ContactProblem      problem;
    ContactBodies       bodies;
    ContactActiveSet    active;
    ContactBonds        bonds;
    std::vector<double> sub_px, sub_py, sub_ps; // impulses on the grains [N s/m]
    struct WallImpulse
    {
      std::size_t           wall;
      std::array<double, 2> impulse;
    };
    std::vector<WallImpulse> on_walls; // from each contact [N s/m]
    std::vector<double>      weight;   // what the loads give each grain along gravity [N s/m]

    // Scratch of a step.
    ContactMaterials                   materials;
    const Cohesion                    *cohesion = nullptr; // none
    std::vector<std::array<double, 2>> wall_impulse;       // of each segment, over the sub-steps [N s/m]
    double                             base_h = 0.;        // length of an unhalved sub-step
    double                             d_min = 0., d_max = 0., mean_mass = 0., g = 0.;
    std::array<double, 2>              down{}; // unit vector of gravity

    // All grains, of which a rank that shares them with others moves a part; see ContactShare.
    GrainArrays      *all       = nullptr;
    const GrainLoads *all_loads = nullptr;
    bool              shared    = false;

    std::size_t          n_owned() const { return shared ? share->n_owned() : all->n(); }
    ContactCommunicator *communicator() const { return shared ? &share->exchange() : nullptr; }
    void                 set_shared(bool now);
    void                 search(double h, double slack);

    const ContactSolver &solver() const
    {
      if (!choice.name().empty())
        return choice.get();
      if (!own_solver)
        own_solver = Registry<ContactSolver>::entries().at(default_solver).create();
      return *own_solver;
    }

    void           set_scales(const GrainArrays &grains, std::array<double, 2> gravity);
    unsigned int   count_substeps(const GrainArrays &grains, const GrainLoads &loads, double dt) const;
    void           find_weights(const GrainLoads &loads, double h);
    void           set_heights(const GrainArrays &grains);
    double         root_mean_square_speed() const; // at the start of the sub-step, of all grains
    ContactMargins choose_margins(double h, double velocity_scale) const;
    Outcome        solve(const GrainArrays    &grains,
                         const GrainLoads     &loads,
                         const ContactMargins &margins,
                         double                slack,
                         double                wall_speed,
                         ContactReport        &report);
    void           move(GrainArrays &grains, double h, ContactReport &report);
    void           add_wall_impulses();
    void           substep(GrainArrays &grains, const GrainLoads &loads, double h, unsigned int level, ContactReport &);
  };


  void ContactStepper::Implementation::find_weights(const GrainLoads &loads, const double h)
  {
    weight.resize(bodies.n_discs());
    for (std::size_t k = 0; k < weight.size(); ++k)
      weight[k] = h * (loads.fx[k] * down[0] + loads.fy[k] * down[1]);
  }


  void ContactStepper::Implementation::set_heights(const GrainArrays &grains)
  {
    problem.height.resize(g > 0. ? bodies.n_discs() : 0);
    for (std::size_t k = 0; k < problem.height.size(); ++k)
      problem.height[k] = -(grains.x[k] * down[0] + grains.y[k] * down[1]);
  }


  double ContactStepper::Implementation::root_mean_square_speed() const
  {
    const auto sum = sum_over_ranks<1>(communicator(), n_owned(), all->n(), [&](const std::size_t k) {
      const Disc &v = bodies.start[k];
      return std::array<double, 1>{{v.x * v.x + v.y * v.y}};
    });
    return std::sqrt(sum[0] / all->n());
  }


  void ContactStepper::Implementation::set_shared(const bool now)
  {
    if (shared && !now)
      neighbours.set_archive(archive());
    shared = now;
  }


  /** Find the pairs anew. With several ranks, also who owns what: the grains' arrays and the bodies change then. */
  void ContactStepper::Implementation::search(const double h, const double slack)
  {
    if (!shared)
      {
        neighbours.search(*all, geometry, slack);
        return;
      }
    share->collect(*all, touched);
    neighbours.set_archive(archive());
    neighbours.search(*all, geometry, slack);
    const auto        was_touched = touched;
    ContactCandidates mine        = share->divide(*all, *all_loads, neighbours.pairs, neighbours.n_colours);
    neighbours.keep(std::move(mine), share->grains, share->n_owned());
    for (std::size_t k = 0; k < share->touched.size(); ++k)
      share->touched[k] = was_touched[share->number_of(k)];
    bodies.set(share->grains, share->loads, h, settings.rotation);
  }


  ContactMargins ContactStepper::Implementation::choose_margins(const double h, const double velocity_scale) const
  {
    // Without gravity, overlaps must open also when all else has come to rest.
    const double   velocity_unit = g > 0. ? std::sqrt(g * d_min) : std::max(velocity_scale, 0.01 * d_min / base_h);
    ContactMargins margins;
    margins.h          = h;
    margins.base_h     = base_h;
    margins.delta      = std::min(settings.dead_zone * base_h * velocity_unit, 1e-3 * d_min);
    margins.push_out   = settings.push_out * velocity_unit;
    margins.correction = settings.correction;
    margins.threshold  = settings.threshold_velocity;
    // The faster the grains, the more likely a solution closes a gap. Fewer rounds then.
    margins.nearness =
      std::max({2. * margins.delta, 2e-3 * d_min, std::min(h * root_mean_square_speed(), 0.1 * d_min)});
    return margins;
  }


  /** Solve with the contacts that are close or closing; if the solution makes others close, add them and solve on. */
  ContactStepper::Implementation::Outcome ContactStepper::Implementation::solve(const GrainArrays    &grains,
                                                                                const GrainLoads     &loads,
                                                                                const ContactMargins &margins,
                                                                                double                slack,
                                                                                const double          wall_speed,
                                                                                ContactReport        &report)
  {
    const double h = margins.h;
    // A bed at rest, or a cold one, is not on the move, however many sweeps it takes.
    const bool on_the_move = root_mean_square_speed() > settings.moving_speed * problem.impulse_scale / mean_mass;
    // A residual makes a bed creep, at a speed in proportion to it and to the sub-step.
    const double     wider = g > 0. ? std::clamp(0.2 * std::sqrt(d_min / g) / h, 1., 10.) : 1.;
    ContactTolerance tolerance{wider * settings.residual_tolerance,
                               wider * settings.violation_tolerance,
                               settings.loose,
                               on_the_move ? settings.patience : 10 * settings.patience,
                               false,
                               settings.max_sweeps};
    Outcome          outcome;
    problem.communicator  = communicator();
    problem.n_owned_discs = n_owned();
    for (bool keep = false;; keep = true)
      {
        active.select(grains, bodies, geometry, materials, margins, keep, neighbours.pairs);
        active.build(neighbours.n_colours, grains, bodies, geometry, materials, problem);
        problem.discs   = bodies.free;
        problem.n_discs = bodies.n_discs();
        set_heights(grains);
        ContactSolution &solution = outcome.solution;
        if (!keep && settings.cold_start && g > 0. && active.is_cold(margins.delta, all->n(), problem))
          {
            tolerance.at_rest = true; // also in later rounds
            find_weights(loads, h);
            solution = solve_cold(problem, {grains.x, grains.y, grains.radius}, {down, weight}, solver(), tolerance);
          }
        else
          solution = solver().solve(problem, tolerance);
        report.n_sweeps += solution.sweeps;
        report.n_updates += static_cast<unsigned long long>(solution.sweeps) * problem.n_counted();
        active.take_impulses(problem);
        if (solution.converged && solution.residual > tolerance.residual)
          ++report.n_loose;
        const auto speeds = largest_over_ranks(communicator(), largest_speeds(problem.discs, n_owned()));
        if (!std::isfinite(speeds[0]))
          throw std::runtime_error("A grain velocity is not a finite number after the contact solve.");
        outcome.speed   = speeds[0];
        outcome.too_far = h * speeds[0] > 2. * settings.max_move * d_min;
        if (!solution.converged || outcome.too_far)
          return outcome;
        const double reach = h * (speeds[0] + speeds[1] + wall_speed);
        if (reach > slack)
          {
            slack = 1.2 * reach;
            std::vector<double> velocity;
            if (shared)
              {
                for (std::size_t k = 0; k < n_owned(); ++k)
                  velocity.insert(velocity.end(), {problem.discs[k].x, problem.discs[k].y});
                velocity = share->collect_rows(velocity, 2);
              }
            search(h, slack);
            if (shared)
              {
                problem.n_owned_discs = n_owned();
                problem.discs         = bodies.free;
                for (std::size_t k = 0; k < bodies.n_discs(); ++k)
                  {
                    problem.discs[k].x = velocity[2 * share->number_of(k)];
                    problem.discs[k].y = velocity[2 * share->number_of(k) + 1];
                  }
              }
            active.restart_from_impulses(neighbours.pairs);
            active.add_violated(grains, bodies, geometry, problem.discs, h, neighbours.pairs);
          }
        else if (!any_over_ranks(communicator(),
                                 active.add_violated(grains, bodies, geometry, problem.discs, h, neighbours.pairs)))
          return outcome;
      }
  }


  void ContactStepper::Implementation::substep(
    GrainArrays &grains, const GrainLoads &loads, const double h, const unsigned int level, ContactReport &report)
  {
    bodies.set(grains, loads, h, settings.rotation);
    bonds.reset(cohesion ? grains.n() : 0, cohesion ? geometry.walls.segments().size() : 0);
    const double wall_speed = geometry.walls.largest_speed();

    // Scales: what gravity does in the sub-step; without gravity, what moves.
    const auto speeds         = largest_over_ranks(communicator(), largest_speeds(bodies.start, n_owned()));
    double     velocity_scale = g * h;
    if (!(velocity_scale > 0.))
      velocity_scale =
        std::max({speeds[0], max_over_ranks(communicator(), largest_speeds(bodies.free, n_owned())[0]), wall_speed});
    if (!(velocity_scale > 0.))
      velocity_scale = 1e-3 * d_min / h;
    problem.impulse_scale  = mean_mass * velocity_scale;
    ContactMargins margins = choose_margins(h, velocity_scale);

    neighbours.rescale(h);
    const double reach    = h * (speeds[0] + speeds[1] + wall_speed + 2. * g * h);
    const bool   known    = !any_over_ranks(communicator(), !neighbours.known(grains));
    double       slack    = known ? neighbours.slack(grains, geometry.periodicity, communicator()) : -1.;
    const double nearness = std::max(margins.nearness, cohesion ? cohesion->reach(0.5 * d_max) : 0.);
    if (slack < nearness + reach)
      {
        slack = std::max(settings.skin * d_max + nearness - margins.nearness, 1.2 * reach + nearness);
        search(h, slack);
      }

    if (cohesion)
      bonds.attract(grains, geometry, *cohesion, h, std::max(margins.delta, 1e-9 * d_min), neighbours.pairs, bodies);

    Outcome      outcome = solve(grains, loads, margins, slack, wall_speed, report);
    const auto   before  = sum_motion(bodies.free, n_owned(), all->n(), communicator());
    const double extra   = wall_speed + margins.push_out;
    const bool   runaway = has_runaway_impulse(problem, before, extra),
               gain      = materials.bounces && has_gained_energy(problem, all->n(), before, extra);
    if ((!outcome.solution.converged || outcome.too_far || gain) && !runaway && level < settings.max_halvings)
      {
        ++report.n_halvings;
        for (int half = 0; half < 2; ++half)
          substep(grains, loads, 0.5 * h, level + 1, report);
        return;
      }
    if (runaway || gain)
      {
        if (runaway)
          neighbours.drop_impulses();
        margins.gentle = true;
        slack          = neighbours.slack(grains, geometry.periodicity, communicator());
        outcome        = solve(grains, loads, margins, slack, wall_speed, report);
      }
    if (!outcome.solution.converged)
      ++report.n_unconverged;

    move(grains, h, report);
    if (cohesion)
      ContactBonds::update(grains, geometry, *cohesion, neighbours.pairs);
    geometry.walls.move(h);
    neighbours.walls_moved(h * wall_speed);
    ++report.n_substeps;
    report.residual     = std::max(report.residual, outcome.solution.residual);
    report.violation    = std::max(report.violation, outcome.solution.violation);
    report.max_velocity = outcome.speed;
  }


  /** Final velocities from the impulses themselves, so that momentum is balanced to round-off. */
  void ContactStepper::Implementation::move(GrainArrays &grains, const double h, ContactReport &report)
  {
    for (auto *sum : {&sub_px, &sub_py, &sub_ps})
      sum->assign(bodies.n_discs() + ContactBodies::n_dummies, 0.);
    std::vector<std::uint8_t> &touches = shared ? share->touched : touched;
    report.n_contacts                  = 0;
    on_walls.clear();
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact &c = problem.contacts[k];
        if (c.rn == 0. && c.rt == 0.)
          continue;
        report.n_contacts += problem.counts(c);
        const double ix = c.rn * c.nx - c.rt * c.ny, iy = c.rn * c.ny + c.rt * c.nx;
        sub_px[c.i] -= ix;
        sub_py[c.i] -= iy;
        sub_ps[c.i] -= c.rt;
        sub_px[c.j] += ix;
        sub_py[c.j] += iy;
        sub_ps[c.j] -= c.rt;
        if (!problem.rolling.empty())
          {
            sub_ps[c.i] -= problem.rolling[k].lever_i * problem.rolling[k].impulse;
            sub_ps[c.j] += problem.rolling[k].lever_j * problem.rolling[k].impulse;
          }
        touches[c.i]            = 1;
        const std::int64_t wall = active.wall_of(k);
        if (wall >= 0)
          on_walls.push_back({static_cast<std::size_t>(wall), {{ix, iy}}});
        else
          touches[c.j] = 1;
      }
    add_wall_impulses();
    for (std::size_t k = 0; k < n_owned(); ++k)
      {
        grains.vx[k] = bodies.free[k].x + bodies.free[k].inverse_mass * sub_px[k];
        grains.vy[k] = bodies.free[k].y + bodies.free[k].inverse_mass * sub_py[k];
        if (settings.rotation)
          grains.omega[k] += bodies.free[k].inverse_rotation * sub_ps[k] / grains.radius[k];
        grains.x[k] += h * grains.vx[k];
        grains.y[k] += h * grains.vy[k];
        grains.fcx[k] += sub_px[k];
        grains.fcy[k] += sub_py[k];
      }
    wrap_into_box(grains, geometry.periodicity);
    if (shared)
      share->update_ghosts();
    for (std::size_t k = 0; k < bonds.on_grain.size(); ++k)
      {
        grains.fcx[k] += bonds.on_grain[k][0];
        grains.fcy[k] += bonds.on_grain[k][1];
      }
    for (std::size_t k = 0; k < bonds.on_wall.size(); ++k)
      for (unsigned int d = 0; d < 2; ++d)
        wall_impulse[k][d] += bonds.on_wall[k][d];
  }


  /** Sum what each wall got in a sub-step; as sum_over_ranks(), but all walls at once. */
  void ContactStepper::Implementation::add_wall_impulses()
  {
    if (wall_impulse.empty())
      return;
    const std::size_t                  n_all = count_over_ranks(communicator(), on_walls.size());
    std::vector<std::array<double, 2>> sums(wall_impulse.size(), {{0., 0.}});
    for (const WallImpulse &p : on_walls)
      for (unsigned int d = 0; d < 2; ++d)
        sums[p.wall][d] = std::max(sums[p.wall][d], std::abs(p.impulse[d]));
    if (shared)
      communicator()->max(sums[0].data(), 2 * sums.size());
    std::vector<std::array<double, 2>> shifts(sums.size());
    for (std::size_t w = 0; w < sums.size(); ++w)
      for (unsigned int d = 0; d < 2; ++d)
        shifts[w][d] = ReproducibleSum(n_all * sums[w][d]).unit_shift();
    sums.assign(sums.size(), {{0., 0.}});
    for (const WallImpulse &p : on_walls)
      for (unsigned int d = 0; d < 2; ++d)
        sums[p.wall][d] += (p.impulse[d] + shifts[p.wall][d]) - shifts[p.wall][d];
    if (shared)
      communicator()->sum(sums[0].data(), 2 * sums.size());
    for (std::size_t w = 0; w < sums.size(); ++w)
      for (unsigned int d = 0; d < 2; ++d)
        wall_impulse[w][d] += sums[w][d];
  }


  void ContactStepper::Implementation::set_scales(const GrainArrays &grains, const std::array<double, 2> gravity)
  {
    const auto [r_min, r_max] = std::minmax_element(grains.radius.begin(), grains.radius.end());
    d_min                     = 2. * *r_min;
    d_max                     = 2. * *r_max;
    g                         = std::hypot(gravity[0], gravity[1]);
    down       = g > 0. ? std::array<double, 2>{{gravity[0] / g, gravity[1] / g}} : std::array<double, 2>{};
    double sum = 0.;
    for (const double m : grains.mass)
      sum += 1. / m;
    // harmonic: the light grains decide, and fixed ones (infinite mass) do not count
    mean_mass = sum > 0. ? grains.n() / sum : 1.;
  }


  /** From the largest speed, now or at the end if last step's contact forces go on; substep() halves if that is wrong.
   */
  unsigned int ContactStepper::Implementation::count_substeps(const GrainArrays &grains,
                                                              const GrainLoads  &loads,
                                                              const double       dt) const
  {
    double speed = 0.;
    for (std::size_t k = 0; k < grains.n(); ++k)
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
    return std::max(1., n_substeps);
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
    for (const WallSegment &w : geometry.walls.segments())
      report.wall_force[w.name] = {{0., 0.}};
    touched.assign(n, 0);
    if (n == 0 || !(dt > 0.))
      return report;

    materials = make_materials(settings, geometry.walls.segments());
    cohesion  = acting_cohesion();
    set_scales(grains, gravity);
    if (model == "soft-sphere")
      {
        check_user(!materials.rolls && !cohesion,
                   "Contacts/Contact model: soft spheres know neither rolling friction nor cohesion.");
        return soft_spheres.advance(
          grains, loads, dt, materials, settings.rotation, settings.skin * d_max, geometry, neighbours, touched);
      }
    rest.steps = settings.rest_steps;
    const Rest::Scales scales{dt, g, mean_mass * g, d_min};
    if (geometry.walls.largest_speed() == 0. && rest.holds(grains, loads, scales))
      return rest.stand_still(loads, grains, touched);

    wall_impulse.assign(geometry.walls.segments().size(), {{0., 0.}});
    const unsigned int steps = count_substeps(grains, loads, dt);
    base_h                   = dt / steps;
    // Until the end, contact forces are impulses, summed over the sub-steps.
    grains.fcx.assign(n, 0.);
    grains.fcy.assign(n, 0.);
    all       = &grains;
    all_loads = &loads;
    set_shared(shares(n));
    if (shared && share->fits(grains))
      share->load(grains, loads);
    else if (shared)
      share->divide(grains, loads, {}, 0);
    for (unsigned int s = 0; s < steps; ++s)
      if (shared)
        substep(share->grains, share->loads, base_h, 0, report);
      else
        substep(grains, loads, base_h, 0, report);
    active.measure_overlaps(
      shared ? share->grains : grains, geometry, problem, report.mean_penetration, report.max_penetration);
    report.n_contacts = count_over_ranks(communicator(), report.n_contacts);
    report.n_updates  = count_over_ranks(communicator(), report.n_updates);
    if (shared)
      share->collect(grains, touched);

    for (std::size_t k = 0; k < n; ++k)
      {
        grains.fcx[k] /= dt;
        grains.fcy[k] /= dt;
      }
    for (std::size_t k = 0; k < wall_impulse.size(); ++k)
      {
        auto &force = report.wall_force[geometry.walls.segments()[k].name];
        force[0] += wall_impulse[k][0] / dt;
        force[1] += wall_impulse[k][1] / dt;
      }
    rest.watch(grains, loads, scales, touched, report);
    return report;
  }


  std::vector<ContactForce> ContactStepper::Implementation::forces(const GrainArrays &grains) const
  {
    std::vector<ContactForce> result;
    if ((shared && !share->fits(grains)) || !neighbours.known(shared ? share->grains : grains))
      return result;
    const bool soft = model == "soft-sphere";
    const auto add  = [&](const ContactPair &p, const bool wall) {
      ContactPoint point;
      if (p.rn == 0. && !p.bonded)
        return;
      if (wall && !geometry.walls.touch(p.j, grains.x[p.i], grains.y[p.i], grains.radius[p.i], point))
        return;
      if (!wall)
        point = touch(grains, geometry.periodicity, p.i, p.j);
      const double ri = grains.radius[p.i], rj = wall ? 0. : grains.radius[p.j];
      ContactForce f{p.i, p.j, wall, point.nx, point.ny, ri + rj + point.gap, p.rn, 0.};
      if (soft)
        f.tangential = soft_spheres.spring_force(p);
      else
        {
          f.normal     = p.rn / neighbours.substep();
          f.tangential = p.rt / neighbours.substep();
          if (cohesion && p.bonded)
            f.normal -= cohesion->force(std::max(point.gap, 0.), wall ? ri : ri * rj / (ri + rj));
        }
      result.push_back(f);
    };
    if (shared)
      {
        const auto number = [&](const GrainId id) {
          return static_cast<std::uint32_t>(std::lower_bound(grains.id.begin(), grains.id.end(), id) -
                                            grains.id.begin());
        };
        for (const ContactArchive::Entry &e : archive().entries)
          {
            ContactPair p{number(e.a), e.wall ? ~e.b : number(e.b)};
            p.bonded = e.bonded;
            p.rn     = e.rn;
            p.rt     = e.rt;
            add(p, e.wall);
          }
        return result;
      }
    for (const ContactPair &p : neighbours.pairs.discs)
      add(p, false);
    for (const ContactPair &p : neighbours.pairs.walls)
      add(p, true);
    return result;
  }


  ContactStepper::ContactStepper()
    : implementation(std::make_unique<Implementation>())
  {}

  ContactStepper::~ContactStepper() = default;

  void ContactStepper::add_parameters(dealii::ParameterHandler &prm)
  {
    implementation->settings.add_parameters(prm);
    prm.add_parameter(
      "Contact model",
      implementation->model,
      "`non-smooth`: impulses that keep grains apart, with any time step; `soft-sphere`: springs between "
      "grains that overlap, with as many sub-steps as their stiffness needs, for comparison.",
      dealii::Patterns::Selection("non-smooth|soft-sphere"));
    implementation->soft_spheres.add_parameters(prm);
    implementation->choice.add_parameters(
      prm, "Contact solver", default_solver, "How the contact problem of a sub-step is solved.");
    implementation->cohesion_choice.add_parameters(
      prm, "Cohesion", "none", "What attracts grains, and grains and walls.");
  }

  ContactSettings &ContactStepper::settings()
  {
    return implementation->settings;
  }

  void ContactStepper::set_walls(std::vector<WallSegment> walls)
  {
    make_materials(settings(), walls);
    implementation->geometry.walls.set(std::move(walls));
    implementation->neighbours.forget();
    implementation->rest.forget();
  }

  const std::vector<WallSegment> &ContactStepper::walls() const
  {
    return implementation->geometry.walls.segments();
  }

  void ContactStepper::set_periodicity(const Periodicity &periodicity)
  {
    implementation->geometry.periodicity = periodicity;
    implementation->neighbours.forget();
  }

  ContactReport ContactStepper::advance(GrainArrays                &grains,
                                        const GrainLoads           &loads,
                                        const double                dt,
                                        const std::array<double, 2> gravity)
  {
    return implementation->advance(grains, loads, dt, gravity);
  }

  void ContactStepper::set_communicator(const MPI_Comm communicator)
  {
    implementation->set_communicator(communicator);
  }

  std::string ContactStepper::sharing(const std::size_t n_grains) const
  {
    const unsigned int n_ranks = implementation->share ? implementation->share->n_ranks() : 1;
    if (n_ranks == 1)
      return "on one rank";
    if (implementation->shares(n_grains))
      return "shared by " + std::to_string(n_ranks) + " ranks";
    return std::string("not shared, all ") + std::to_string(n_ranks) + " ranks do the same: " +
           (implementation->model != "non-smooth"          ? "soft spheres"
            : implementation->acting_cohesion() != nullptr ? "cohesion"
                                                           : "too few grains a rank (Contacts/Least grains a rank)");
  }

  ContactTraffic ContactStepper::traffic() const
  {
    return implementation->share ? implementation->share->traffic() : ContactTraffic();
  }

  const std::vector<std::uint8_t> &ContactStepper::touched() const
  {
    return implementation->touched;
  }

  std::vector<ContactForce> ContactStepper::forces(const GrainArrays &grains) const
  {
    return implementation->forces(grains);
  }

  void ContactStepper::forget_search()
  {
    implementation->neighbours.forget();
    implementation->rest.forget();
  }

  ContactArchive ContactStepper::archive() const
  {
    ContactArchive result = implementation->archive();
    result.wall_positions = implementation->geometry.walls.positions();
    return result;
  }

  void ContactStepper::set_archive(ContactArchive archive)
  {
    implementation->geometry.walls.place(archive.wall_positions);
    implementation->neighbours.set_archive(std::move(archive));
    implementation->rest.forget();
  }
} // namespace alluvium::grains
