#include <alluvium/contacts/contact_plausibility.h>
#include <alluvium/contacts/contact_substep.h>
#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_reductions.h>
#include <alluvium/contacts/solvers/hydrostatic_guess.h>
#include <alluvium/utilities/divergence.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace alluvium::contacts
{
  void ContactSubstep::begin(Step new_step)
  {
    step = std::move(new_step);
    motion.reset(local.geometry.walls.segments().size());
  }


  void ContactSubstep::advance(const double h, const unsigned int level, ContactReport &report)
  {
    local.geometry.walls.begin_substep(h);
    bodies.set(local.grains(), local.loads(), h, settings.rotation);
    set_margins(h);
    local.neighbours.rescale(h);
    search_if_due();
    const Cohesion *const cohesion = step.cohesion;
    bonds.reset(cohesion ? local.n_all() : 0, cohesion ? local.geometry.walls.segments().size() : 0);
    if (cohesion)
      bonds.attract(local.grains(),
                    local.geometry,
                    *cohesion,
                    h,
                    std::max(margins.delta, 1e-9 * step.scales.d_min),
                    local.neighbours.pairs,
                    bodies);

    const bool may_halve = level < settings.max_halvings;
    Outcome    outcome   = solve(report, may_halve);
    bool       diverged = false, gained_energy = false;
    const bool bounces = step.materials.bounces || step.materials.law;
    // Most impulses are no larger than what the masses alone allow, which needs no sums over all grains.
    const double extra = margins.wall_speed + margins.depenetration_speed;
    if (const double largest = max_over_ranks(local.communicator(), outcome.largest_impulse);
        bounces || has_diverged(largest, {0.99 * step.scales.mass, 0., 0.}, extra))
      {
        const auto before = sum_motion(bodies.free, local.n_owned(), local.n_all(), local.communicator());
        diverged          = has_diverged(largest, before, extra);
        gained_energy     = bounces && has_gained_energy(problem, local.n_all(), before, extra);
      }
    const bool solved =
      outcome.solution.converged || (outcome.solution.stalled && !(may_halve && settings.halve_stalled));
    if ((!solved || outcome.too_far || gained_energy) && !diverged && may_halve)
      {
        ++report.n_halvings;
        for (int half = 0; half < 2; ++half)
          advance(0.5 * h, level + 1, report);
        return;
      }
    if (diverged || gained_energy)
      {
        if (diverged)
          local.neighbours.drop_impulses();
        margins.inelastic = true;
        slack             = local.slack();
        outcome           = solve(report, false);
      }
    if (outcome.solution.stalled)
      ++report.n_stalled;
    else if (!outcome.solution.converged)
      ++report.n_unconverged;

    report.n_contacts = motion.move(problem, active, bodies, bonds, h, settings.rotation, local);
    if (cohesion)
      ContactBonds::update(local.grains(), local.geometry, *cohesion, local.neighbours.pairs);
    local.geometry.walls.move(h);
    local.neighbours.walls_moved(h * margins.wall_speed);
    if (!outcome.solution.converged || outcome.too_far || diverged || gained_energy)
      look_for_crushed(report);
    ++report.n_substeps;
    report.residual        = std::max(report.residual, outcome.solution.residual);
    report.violation       = std::max(report.violation, outcome.solution.violation);
    report.smooth_velocity = std::fmax(report.smooth_velocity, outcome.smooth); // either may be no number
    report.max_velocity    = outcome.speed;
  }


  /** Scales of the sub-step: what gravity does in it; without gravity, what moves. */
  void ContactSubstep::set_margins(const double h)
  {
    ContactCommunicator *const communicator = local.communicator();
    const ContactScales       &scales       = step.scales;
    margins                                 = {};
    margins.h                               = h;
    margins.base_h                          = step.base_h;
    margins.wall_speed                      = local.geometry.walls.largest_speed();
    margins.speeds        = measure_speeds(local.grains(), local.n_owned(), local.n_all(), communicator);
    double velocity_scale = scales.g * h;
    if (!(velocity_scale > 0.))
      velocity_scale = std::max({margins.speeds.largest[0],
                                 max_over_ranks(communicator, largest_speeds(bodies.free, local.n_owned())[0]),
                                 margins.wall_speed});
    if (!(velocity_scale > 0.))
      velocity_scale = 1e-3 * scales.d_min / h;
    problem.impulse_scale           = scales.mean_mass * velocity_scale;
    constexpr double very_different = 5e3; // masses that no contact of the lighter one weighs
    problem.heaviest                = scales.heaviest > very_different * scales.lightest ? scales.heaviest : 0.;
    problem.velocity_scale          = velocity_scale;

    // Without gravity, overlaps must open also when all else has come to rest.
    const double velocity_unit =
      scales.g > 0. ? std::sqrt(scales.g * scales.d_min) : std::max(velocity_scale, 0.01 * scales.d_min / step.base_h);
    margins.delta               = std::min(settings.dead_zone * step.base_h * velocity_unit, 1e-3 * scales.d_min);
    margins.depenetration_speed = settings.depenetration_speed * velocity_unit;
    margins.correction          = settings.correction;
    margins.threshold           = settings.threshold_velocity;
    // The faster the grains, the more likely a solution closes a gap. Fewer rounds then.
    margins.alert_distance =
      std::max({2. * margins.delta, 2e-3 * scales.d_min, std::min(h * margins.speeds.mean, 0.1 * scales.d_min)});
  }


  /**
   * A distance to look for pairs that is above @p needed, by a fifth of what motion adds to @p at_rest where a periodic
   * domain is so wide: a grain must meet another one on one side only.
   */
  double ContactSubstep::with_margin(const double needed, const double at_rest) const
  {
    double fits = std::numeric_limits<double>::infinity();
    for (const double length : local.geometry.periodicity.length)
      if (length > 0.)
        fits = std::min(fits, 0.5 * length - step.scales.d_max);
    // a domain that is too narrow for grains at rest is the user's mistake, which the search reports
    if (needed >= 0.999 * fits && at_rest + settings.skin * step.scales.d_max < fits)
      {
        std::ostringstream text;
        text << "grains, or walls, are so fast that in " << margins.h << " s they go " << needed
             << " m, about half of the domain or more where it is periodic.";
        throw Divergence(text.str());
      }
    return std::min(needed + 0.2 * (needed - at_rest), std::max(0.999 * fits, needed));
  }


  void ContactSubstep::search_if_due()
  {
    const double h = margins.h;
    const double reach =
      h * (margins.speeds.largest[0] + margins.speeds.largest[1] + margins.wall_speed + 2. * step.scales.g * h);
    const double alert_distance =
      std::max(margins.alert_distance, step.cohesion ? step.cohesion->reach(0.5 * step.scales.d_max) : 0.);
    slack = local.known() ? local.slack() : -1.;
    if (slack >= alert_distance + reach)
      return;
    slack = std::max(settings.skin * step.scales.d_max + alert_distance - margins.alert_distance,
                     with_margin(reach + alert_distance, alert_distance));
    local.search(slack);
    if (local.is_partitioned()) // with other grains now
      bodies.set(local.grains(), local.loads(), h, settings.rotation);
  }


  /** The contacts that are close or closing, and with @p keep those that were there before. */
  void ContactSubstep::set_problem(const bool keep)
  {
    const grains::GrainArrays &grains = local.grains();
    problem.communicator              = local.communicator();
    problem.n_owned_discs             = local.n_owned();
    active.select(grains,
                  bodies,
                  local.geometry,
                  step.materials,
                  margins,
                  keep,
                  local.neighbours.n_colours,
                  local.neighbours.pairs,
                  problem);
    problem.discs   = bodies.free;
    problem.n_discs = bodies.n_discs();
    problem.height.resize(step.scales.g > 0. ? bodies.n_discs() : 0);
    for (std::size_t k = 0; k < problem.height.size(); ++k)
      problem.height[k] = -(grains.position[0][k] * step.scales.down[0] + grains.position[1][k] * step.scales.down[1]);
  }


  ContactTolerance ContactSubstep::tolerance(const bool on_the_move) const
  {
    // A residual makes a bed creep, at a speed in proportion to it and to the sub-step: wider in short ones, narrower
    // in those that are long for a grain's fall.
    const double g = step.scales.g;
    const double x = g > 0. ? 0.2 * std::sqrt(step.scales.d_min / g) / margins.h : 1.;
    const double wider =
      std::clamp(x, 1., 10.) * std::clamp(2. * x, 0.1, 1.) * (on_the_move ? step.tolerance_factor : 1.);
    ContactTolerance tolerance;
    tolerance.residual          = wider * settings.residual_tolerance;
    tolerance.violation         = wider * settings.violation_tolerance;
    tolerance.smooth            = wider * settings.smooth_tolerance;
    tolerance.stagnation_factor = settings.stagnation_factor;
    tolerance.stagnation_sweeps = on_the_move ? settings.stagnation_sweeps : 10 * settings.stagnation_sweeps;
    tolerance.max_sweeps        = settings.max_sweeps;
    return tolerance;
  }


  /**
   * Solve with the contacts that are close or closing; if the solution makes others close, add them and solve on. Where
   * grains move too far, give up if that @p may_halve the sub-step.
   */
  ContactSubstep::Outcome ContactSubstep::solve(ContactReport &report, const bool may_halve)
  {
    constexpr double      resting   = 0.02; // rms speed over g h
    constexpr std::size_t least_bed = 1000; // smaller ones need no help
    const bool            is_resting =
      step.scales.g > 0. && local.n_all() >= least_bed && margins.speeds.mean < resting * problem.velocity_scale;
    // A bed at rest, or a cold one, is not on the move, however many sweeps it takes.
    const bool on_the_move     = margins.speeds.mean > settings.moving_speed * problem.velocity_scale;
    report.was_loosened        = report.was_loosened || (on_the_move && step.tolerance_factor > 1.);
    ContactTolerance tolerance = this->tolerance(on_the_move);
    Outcome          outcome;
    ContactSolution &solution = outcome.solution;
    for (bool keep = false;; keep = true)
      {
        set_problem(keep);
        Assert(is_consistent(problem), dealii::ExcMessage("The contacts are not what the solvers rely on."));
        const grains::GrainArrays &grains = local.grains();
        const DiscPlaces           places{grains.position[0], grains.position[1], grains.radius};
        if (is_resting)
          moments.begin(problem, places, local.geometry.periodicity.length);
        problem.correction = nullptr;
        if (!keep && settings.hydrostatic_guess && step.scales.g > 0. && active.is_cold(local.n_all(), problem))
          {
            tolerance.at_rest = true; // also in later rounds
            find_weights();
            solution =
              solve_from_hydrostatic_guess(problem, places, {step.scales.down, weight}, *step.solver, tolerance);
          }
        else
          {
            if (is_resting && settings.moment_correction && !tolerance.at_rest)
              problem.correction = &moments;
            solution = step.solver->solve(problem, tolerance);
          }
        if (problem.correction != nullptr)
          report.n_corrections += moments.n_corrections();
        if (is_resting)
          outcome.smooth = problem.correction != nullptr ? solution.smooth
                                                         : moments.velocity(problem,
                                                                            ContactMeasure(problem).kinetic_energy(),
                                                                            solution.sweeps,
                                                                            tolerance.smooth * problem.velocity_scale) /
                                                             problem.velocity_scale;
        report.n_sweeps += solution.sweeps;
        report.n_updates += static_cast<unsigned long long>(solution.sweeps) * problem.n_counted();
        outcome.largest_impulse = active.take_impulses(problem, local.neighbours.pairs);
        if (solution.converged && solution.residual > tolerance.residual)
          ++report.n_loose;
        const auto speeds = largest_over_ranks(local.communicator(), largest_speeds(problem.discs, local.n_owned()));
        if (!std::isfinite(speeds[0]))
          throw Divergence("A grain velocity is not a finite number after the contact solve.");
        outcome.speed   = speeds[0];
        outcome.too_far = margins.h * speeds[0] > 2. * settings.max_move * step.scales.d_min;
        // What is taken, however far grains move in it, must have all contacts on their way.
        if (!solution.converged || (outcome.too_far && may_halve) || !misses_contacts(speeds))
          return outcome;
      }
  }


  /**
   * Whether grains with the velocities of the solution, of which the two largest are @p speeds, overlap at the end of
   * the sub-step that are in no contact; those take part the next time. Searches if they may be no known pair.
   */
  bool ContactSubstep::misses_contacts(const std::array<double, 2> &speeds)
  {
    const double reach  = margins.h * (speeds[0] + speeds[1] + margins.wall_speed);
    const bool   search = reach > slack;
    // Those that take no part are at least this far apart.
    if (reach < 0.999 * std::min(slack, margins.alert_distance))
      return false;
    if (search)
      {
        slack = with_margin(reach, 0.);
        local.search(slack, problem.discs);
        if (local.is_partitioned())
          bodies.set(local.grains(), local.loads(), margins.h, settings.rotation);
        active.restart_from_impulses(local.neighbours.pairs);
      }
    const bool found =
      active.add_violated(local.grains(), bodies, local.geometry, problem.discs, margins.h, local.neighbours.pairs);
    return search || any_over_ranks(local.communicator(), found);
  }


  /** After a sub-step that was not solved: who is in or behind whom? What was solved leaves no such contacts. */
  void ContactSubstep::look_for_crushed(ContactReport &report) const
  {
    const grains::GrainArrays &grains = local.grains();
    const auto                &walls  = local.geometry.walls;
    const ContactCandidates   &pairs  = local.neighbours.pairs;
    Crush                      worst;
    double                     partner = 0.; // the wall's number and 1, or the grain's beyond those
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      {
        const Contact &c = problem.contacts[k];
        if (!problem.counts(c))
          continue;
        const bool         wall = active.is_wall(k, pairs);
        const ContactPair &pair = active.pair(k, pairs);
        const double       ri = grains.radius[c.i], rj = wall ? 0. : grains.radius[c.j];
        ContactPoint       point{};
        if (!wall)
          point = touch(grains, local.geometry.periodicity, c.i, c.j);
        else
          {
            const grains::WallSegment &w = walls.segments()[pair.j];
            const double               t = project(w, grains.position[0][c.i], grains.position[1][c.i]);
            const double               x = w.a[0] + t * (w.b[0] - w.a[0]) - grains.position[0][c.i],
                         y = w.a[1] + t * (w.b[1] - w.a[1]) - grains.position[1][c.i], distance = std::hypot(x, y);
            point = {x, y, distance - ri};
          }
        const bool passed = point.nx * c.nx + point.ny * c.ny < 0.;
        // what it touches at a joint may be another wall's
        if (ContactPoint own;
            wall && !passed && !walls.touch(pair.j, grains.position[0][c.i], grains.position[1][c.i], ri, own))
          continue;
        const double gap   = passed ? -(point.gap + 2. * (ri + rj)) : point.gap;
        const double depth = -gap / (2. * (wall ? ri : std::min(ri, rj)));
        const double other = wall ? 1. + pair.j : 1. + walls.segments().size() + grains.id[c.j];
        if (depth > worst.depth)
          {
            worst   = {depth, grains.id[c.i], 0, "", passed};
            partner = other;
          }
      }
    // one of those that are deepest on any rank: the one of the highest grain and partner
    ContactCommunicator *const communicator = local.communicator();
    const double               depth        = max_over_ranks(communicator, worst.depth);
    const auto                 agree        = [&](const bool mine, const double number) {
      return max_over_ranks(communicator, mine ? number : 0.);
    };
    const bool   mine  = worst.depth == depth && depth > 0.;
    const double a     = agree(mine, 1. + worst.a);
    const bool   first = mine && 1. + worst.a == a;
    const double b     = agree(first, partner);
    const bool   gone  = agree(first && partner == b, worst.passed ? 1. : 0.) > 0.;
    if (depth <= report.crush.depth)
      return;
    report.crush         = {depth, static_cast<grains::GrainId>(a - 1.), 0, "", gone};
    const double n_walls = walls.segments().size();
    if (b <= n_walls)
      report.crush.wall = walls.segments()[static_cast<std::size_t>(b - 1.)].name;
    else
      report.crush.b = static_cast<grains::GrainId>(b - 1. - n_walls);
  }


  void ContactSubstep::find_weights()
  {
    const grains::GrainLoads    &loads = local.loads();
    const std::array<double, 2> &down  = step.scales.down;
    weight.resize(bodies.n_discs());
    for (std::size_t k = 0; k < weight.size(); ++k)
      weight[k] = margins.h * (loads.force[0][k] * down[0] + loads.force[1][k] * down[1]);
  }


  void ContactSubstep::finish(ContactReport &report)
  {
    active.measure_overlaps(
      local.grains(), local.geometry, problem, local.neighbours.pairs, report.mean_penetration, report.max_penetration);
    report.n_contacts = count_over_ranks(local.communicator(), report.n_contacts);
    report.n_updates  = count_over_ranks(local.communicator(), report.n_updates);
  }
} // namespace alluvium::contacts
