#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/rotation.h>
#include <alluvium/fluid/largest_speed.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace alluvium::coupling
{
  using namespace dealii;

  Coupling::Coupling(const fluid::FluidSpace<dim> &space, fluid::VansSolver<dim> &solver)
    : space(&space)
    , solver(&solver)
    , map(space)
  {}


  void Coupling::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Coupling");
    overlap_parameters.add_parameters(prm);
    prm.add_parameter("Added mass coefficient",
                      added_mass,
                      "C_m of the added mass C_m rho V (Du/Dt - dv/dt): 0.5 for spheres, 1 for discs; 0: none. Needs a "
                      "semi-implicit time scheme.",
                      Patterns::Double(0.));
    prm.add_parameter("Rotation",
                      rotation,
                      "Couple the grains' spin with the fluid: drag sees the velocity of every point of a grain, and "
                      "turns the grain. Without it the fluid exerts no torque.");
    drag_choice.add_parameters(prm, "Drag law", "disc", "Closure for the drag f = gamma (u - v) per volume of grain.");
    regularisation_choice.add_parameters(
      prm,
      "Drag regularisation",
      "floor",
      "What to do where the void fraction is far below that of any packing: inside grains, on fine meshes without a "
      "filter.");
    scheme_choice.add_parameters(
      prm, "Time scheme", "iterated", "How grains and fluid see each other's velocity within a time step.");
    prm.leave_subsection();
  }


  void Coupling::parse_parameters()
  {
    settings           = overlap_parameters.settings();
    settings.keep_arms = rotation;
    check_user(
      added_mass == 0. || scheme_choice.get().predicts_acceleration(),
      "Coupling/Added mass coefficient: added mass needs a time scheme that predicts how the grains accelerate, "
      "such as `semi-implicit per grain`; '" +
        scheme_choice.name() + "' does not.");
  }


  void Coupling::reinit()
  {
    map.reinit();
    still = resumes = false;
    space->reinit_nodal_field(eps);
    space->reinit_field(latest_sweep);
    latest_sweep.update_ghost_values(); // it may be read before there is one
  }


  bool Coupling::update_void_fraction(const grains::GrainArrays &grains)
  {
    const auto timer = solver->timers.scope("fluid: overlap");
    if (!map.cut(grains, settings))
      {
        last = of_void_fraction;
        return false;
      }
    last                = {};
    last.clipped_volume = map.void_fraction(eps);
    double low = 1., high = 0.;
    for (unsigned int i = 0; i < eps.locally_owned_size(); ++i)
      {
        low  = std::min(low, eps.local_element(i));
        high = std::max(high, eps.local_element(i));
      }
    last.eps_min     = Utilities::MPI::min(low, space->communicator());
    last.eps_max     = Utilities::MPI::max(high, space->communicator());
    last.n_pieces    = Utilities::MPI::sum(map.grain().size(), space->communicator());
    of_void_fraction = last;
    return true;
  }


  Coupling::Inputs Coupling::inputs_of(const grains::GrainArrays       &grains,
                                       const std::vector<std::uint8_t> &touched,
                                       const double                     dt,
                                       const bool                       fixed)
  {
    return {dt,
            fixed,
            {grains.velocity[0],
             grains.velocity[1],
             grains.omega,
             grains.contact_force[0],
             grains.contact_force[1],
             grains.mass},
            touched};
  }


  void Coupling::remove_grains(const std::vector<std::uint8_t> &keep)
  {
    if (outside.size() == keep.size())
      {
        std::size_t n = 0;
        for (std::size_t g = 0; g < keep.size(); ++g)
          if (keep[g])
            outside[n++] = outside[g];
        outside.resize(n);
      }
    still = resumes = false;
    force.clear(); // until the step finds them anew
    predicted.clear();
    forget_positions();
  }


  void Coupling::save(ByteWriter                      &writer,
                      const grains::GrainArrays       &grains,
                      const std::vector<std::uint8_t> &touched,
                      const double                     dt,
                      const bool                       fixed) const
  {
    writer.put(map.x_of_cut());
    writer.put(map.y_of_cut());
    writer.put(outside);
    writer.put<std::uint8_t>(still && inputs_of(grains, touched, dt, fixed) == last_inputs);
  }


  void Coupling::load(ByteReader &reader, const grains::GrainArrays &grains)
  {
    grains::GrainArrays then = grains;
    then.position[0]         = reader.get_vector<double>();
    then.position[1]         = reader.get_vector<double>();
    outside                  = reader.get_vector<std::uint8_t>();
    const bool same          = reader.get<std::uint8_t>() != 0;
    if (then.position[0].size() != grains.n() || then.position[1].size() != grains.n())
      throw std::runtime_error("The checkpoint has another number of grains.");
    update_void_fraction(then);
    resumes = same;
  }


  void Coupling::step(const fluid::BoundaryConditions<dim> &boundary_conditions,
                      const grains::GrainArrays            &grains,
                      const std::vector<std::uint8_t>      &touched,
                      const double                          dt,
                      const bool                            fixed,
                      grains::GrainLoads                   &loads)
  {
    Assert(touched.size() == grains.n(), ExcDimensionMismatch(touched.size(), grains.n()));
    Assert(eps.size() > 0, ExcMessage("reinit() comes before the first step."));
    Assert(dt > 0., ExcMessage("A step takes time."));
    const CouplingReport before               = last;
    const bool           moved                = update_void_fraction(grains);
    const auto           inputs               = [&] { return inputs_of(grains, touched, dt, fixed); };
    const bool           same_boundary_values = solver->has_boundary_values(boundary_conditions, eps);
    if (!moved && same_boundary_values && still && inputs() == last_inputs)
      {
        last              = before;
        last.steady       = true;
        last.n_iterations = last.n_loose = last.n_direct = 0; // those of rebalance() are counted
        loads                                            = last_loads;
        return;
      }
    auto state_before    = std::move(latest_state);
    latest_state         = std::make_unique<CouplingState>(grains, touched, map, dt);
    CouplingState &state = *latest_state;
    if (state_before)
      state.take_memory_of(*state_before);
    repeated_with.clear();
    find_state(state);

    // grains that cannot move need no prediction
    const TimeScheme       &scheme = fixed ? frozen_scheme() : scheme_choice.get();
    fluid::VansProblem<dim> problem{};
    problem.dt = dt;
    solve(boundary_conditions, scheme, problem, state);
    find_loads(scheme, state, loads);
    still = same_boundary_values && last.n_iterations == 0;
    if (still)
      last_inputs = inputs();
    last.steady = resumes && !moved && still;
    resumes     = false;
    last.n_iterations += std::exchange(of_rebalance.n_iterations, 0);
    last.n_loose += std::exchange(of_rebalance.n_loose, 0);
    last.n_direct += std::exchange(of_rebalance.n_direct, 0);
  }


  void Coupling::repeat(const GrainMotion &answer, const std::vector<double> &weights, grains::GrainLoads &loads)
  {
    Assert(latest_state, ExcMessage("repeat() comes after step()."));
    const TimeScheme &scheme = scheme_choice.get();
    CouplingState    &state  = *latest_state;
    Assert(answer.vx.size() == state.grains.n(), ExcDimensionMismatch(answer.vx.size(), state.grains.n()));
    Assert(map.is_cut_where(state.grains), ExcMessage("The grains of step() must be where they were."));
    Assert(weights.size() <= repeated_with.size() + 1, ExcDimensionMismatch(weights.size(), repeated_with.size() + 1));
    repeated_with.push_back(solver->solution());
    repeated_with.erase(repeated_with.begin(), repeated_with.end() - weights.size());
    state.answer = &answer;
    solver->solve_again([&](auto &) {
      latest_sweep = 0.;
      for (std::size_t i = 0; i < weights.size(); ++i)
        latest_sweep.add(weights[i], repeated_with[i]);
      latest_sweep.update_ghost_values();
      look_at(latest_sweep, state);
      scheme.exchange_terms(state, scheme.n_sweeps(), map.terms().exchange);
    });
    state.answer = nullptr;
    last.n_iterations += solver->last_report().n_iterations;
    last.n_loose += solver->last_report().loose;
    last.n_direct += solver->last_report().direct;
    look_at(solver->solution(), state);
    find_loads(scheme, state, loads);
    still = false;
  }


  void Coupling::find_loads(const TimeScheme &scheme, const CouplingState &state, grains::GrainLoads &loads)
  {
    collect_forces(state);
    loads.reset(state.grains.n());
    scheme.loads(state, force, loads);
    if (rotation)
      find_torques(state, loads);
    last_loads = loads;
  }


  bool Coupling::rebalance(const fluid::BoundaryConditions<dim> &boundary_conditions,
                           const grains::GrainArrays            &grains,
                           const double                          dt,
                           const fluid::BlockVector             &before,
                           const double                          share)
  {
    const std::vector<std::uint8_t> touched(grains.n(), 0);
    still = resumes = false;

    fluid::BlockVector change = solver->old();
    change.zero_out_ghost_values();
    change.add(-1., before);
    double fastest_grain = 0.;
    for (std::size_t g = 0; g < grains.n(); ++g)
      fastest_grain = std::max(fastest_grain, std::hypot(grains.velocity[0][g], grains.velocity[1][g]));
    const double speed        = fluid::largest_speed(*space, solver->old().block(0)),
                 acceleration = fluid::largest_speed(*space, change.block(0)); // times dt
    const bool is_slow        = std::max(acceleration, fastest_grain) <= 1e-2 * speed;
    // what interpolation leaves in a few cells is less than what finding the flow anew does to accelerating grains
    constexpr double small_share = 0.2;
    if (!is_slow && share < small_share)
      return false;

    update_void_fraction(grains);
    CouplingState state(grains, touched, map, dt);
    find_state(state);
    // slow: a step so long that only the acceleration that is given is left; else so long that the slip finds its own
    constexpr double longest = 1e3, n_relaxations = 3.;
    double           factor = is_slow ? longest : std::clamp(n_relaxations * relaxation_time(state) / dt, 1., longest);
    // but no longer than the flow needs to become another one: what is not balanced would carry it anywhere
    if (factor * acceleration > speed)
      factor = std::max(1., speed / acceleration);
    state.dt = factor * dt;
    if (added_mass > 0.)
      find_acceleration(state);
    fluid::BlockVector inertia = solver->old();
    inertia.zero_out_ghost_values();
    inertia.sadd(1. - factor, factor, before);
    inertia.update_ghost_values();
    fluid::VansProblem<dim> problem{};
    problem.dt               = factor * dt;
    problem.inertia          = &inertia;
    problem.stabilisation_dt = dt;
    problem.tolerance_factor = 1. / factor; // what the solver leaves is an acceleration, too: that of a step of dt
    solve(boundary_conditions, frozen_scheme(), problem, state);
    of_rebalance.n_iterations += last.n_iterations;
    of_rebalance.n_loose += last.n_loose;
    of_rebalance.n_direct += last.n_direct;
    if (!is_slow)
      {
        // the pressure that did away with what interpolation left is not that of the flow
        fluid::BlockVector field = solver->solution();
        field.block(1)           = solver->old().block(1);
        solver->set_solution(field);
      }
    return true;
  }


  double Coupling::relaxation_time(const CouplingState &state) const
  {
    double drag = 0., mass = 0.;
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      drag += map.terms().shape[k].area * state.gamma[k];
    for (const double m : state.grains.mass)
      mass += std::isinf(m) ? 0. : m;
    drag = Utilities::MPI::sum(drag, space->communicator());
    return drag > 0. ? mass / drag : 0.;
  }


  void Coupling::find_state(CouplingState &state)
  {
    state.gravity       = {{solver->gravity[0], solver->gravity[1]}};
    state.fluid_density = solver->properties.density;
    state.unsupported   = {{solver->unsupported_weight()[0], solver->unsupported_weight()[1]}};
    evaluate(map, *space, solver->old(), state.old);
    state.latest = state.old;
    if (rotation)
      state.old_gradient = state.latest_gradient = velocity_gradients(map, *space, solver->old());
    find_drag(state);
    if (added_mass > 0.)
      find_acceleration(state);
  }


  void Coupling::solve(const fluid::BoundaryConditions<dim> &boundary_conditions,
                       const TimeScheme                     &scheme,
                       fluid::VansProblem<dim>               problem,
                       CouplingState                        &state)
  {
    auto &exchange = map.terms().exchange;
    scheme.exchange_terms(state, 0, exchange);
    problem.void_fraction = &eps;
    problem.solid         = &map.terms();
    problem.reference     = {{nullptr, &solver->old().block(0), &latest_sweep.block(0)}};
    solver->begin_step(boundary_conditions, problem);
    solver->solve();
    last.n_iterations = solver->last_report().n_iterations;
    last.n_loose      = solver->last_report().loose;
    last.n_direct     = solver->last_report().direct;
    for (unsigned int sweep = 1; sweep < scheme.n_sweeps(); ++sweep)
      {
        look_at(solver->solution(), state);
        solver->solve_again([&](auto &) {
          latest_sweep = solver->solution();
          latest_sweep.update_ghost_values();
          scheme.exchange_terms(state, sweep, exchange);
        });
        last.n_iterations += solver->last_report().n_iterations;
        last.n_loose += solver->last_report().loose;
        last.n_direct += solver->last_report().direct;
      }
    look_at(solver->solution(), state);
  }


  void Coupling::look_at(const fluid::BlockVector &field, CouplingState &state) const
  {
    state.before_latest.swap(state.latest);
    evaluate(map, *space, field, state.latest);
    if (!rotation)
      return;
    state.before_latest_gradient.swap(state.latest_gradient);
    state.latest_gradient = velocity_gradients(map, *space, field);
  }


  void Coupling::find_drag(CouplingState &state)
  {
    const auto        &terms          = map.terms();
    const DragLaw     &law            = drag_choice.get();
    const auto        &regularisation = regularisation_choice.get();
    DragState          s{0., 0., 0., solver->properties.density, solver->properties.viscosity};
    const unsigned int n = space->n_nodes_per_cell();
    state.gamma.resize(terms.n_pieces());
    drag_means.assign(2 * state.grains.n(), 0.);
    for (unsigned int c = 0; c < space->cells().size(); ++c)
      for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
        {
          const unsigned int g = map.grain()[k];
          s.eps                = 0.;
          for (unsigned int v = 0; v < n; ++v)
            s.eps += terms.shape[k].phi[v] * eps.local_element(space->cells()[c].node[v]);
          const auto   spin = state.spin_velocity(k);
          const double ux   = state.old[k].u[0] - state.grains.velocity[0][g] - spin[0];
          const double uy   = state.old[k].u[1] - state.grains.velocity[1][g] - spin[1];
          s.slip            = std::sqrt(ux * ux + uy * uy);
          s.diameter        = 2. * state.grains.fluid_radius[g];
          drag_means[2 * g] += terms.shape[k].area * s.eps;
          drag_means[2 * g + 1] += terms.shape[k].area * s.reynolds();
          state.gamma[k] = regularisation.gamma(law, s);
        }
    auto &spin = map.terms().spin;
    spin.resize(map.arms().size());
    for (std::size_t k = 0; k < spin.size(); ++k)
      spin[k] = {map.arms()[k].moments, map.arms()[k].arm, state.gamma[k]};
  }


  void Coupling::find_acceleration(CouplingState &state) const
  {
    state.added_density = added_mass * solver->properties.density;
    state.acceleration.resize(state.n_pieces());
    const auto gradient = velocity_gradients(map, *space, solver->old());
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const auto &u            = state.old[k].u;
          state.acceleration[k][d] = -u[d] / state.dt;
          if (solver->discretisation.convection)
            state.acceleration[k][d] += u[0] * gradient[k][d][0] + u[1] * gradient[k][d][1];
        }
  }


  void Coupling::find_torques(const CouplingState &state, grains::GrainLoads &loads)
  {
    GrainTorques torques = grain_torques(state);
    loads.torque         = std::move(torques.torque);
    loads.spin_drag      = std::move(torques.spin_drag);

    // what the fluid saw
    const auto                              &exchange = map.terms().exchange;
    double                                   sum      = 0.;
    const std::vector<std::array<double, 2>> shift    = periodic_shifts(state);
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      {
        const auto        &x = exchange[k];
        const unsigned int g = map.grain()[k];
        const double       b = x.gamma * x.compliance, area = map.terms().shape[k].area;
        const auto         f   = piece_force(state, k).force;
        const auto        &arm = map.arms()[k].arm;
        const auto        &c   = map.arms()[k].moments;
        sum += area * ((state.grains.position[0][g] + arm[0] + shift[k][0]) * f[1] -
                       (state.grains.position[1][g] + arm[1] + shift[k][1]) * f[0]);
        sum += (1. - b) * couple(state, k, state.latest_gradient[k]) - area * state.gamma[k] * x.omega * (c[0] + c[2]);
        if (x.reference)
          sum += b * couple(state, k, x.reference == 1 ? state.old_gradient[k] : state.before_latest_gradient[k]);
      }
    last.torque_on_grains = Utilities::MPI::sum(sum, space->communicator());
  }


  std::vector<std::array<double, 2>> Coupling::periodic_shifts(const CouplingState &state) const
  {
    std::vector<std::array<double, 2>> result(state.n_pieces(), {{0., 0.}});
    const auto                         box   = space->periodic_box();
    const unsigned int                 n     = space->n_nodes_per_cell();
    const auto                        &begin = map.terms().begin;
    for (unsigned int d = 0; d < dim; ++d)
      if (box.length[d] > 0.)
        for (unsigned int c = 0; c < space->cells().size(); ++c)
          {
            double middle = 0.;
            for (unsigned int v = 0; v < n; ++v)
              middle += space->cells()[c].vertex[v][d] / n;
            for (unsigned int k = begin[c]; k < begin[c + 1]; ++k)
              {
                const unsigned int g = map.grain()[k];
                const double       position =
                  (d == 0 ? state.grains.position[0][g] : state.grains.position[1][g]) + map.arms()[k].arm[d];
                result[k][d] = box.length[d] * std::round((middle - position) / box.length[d]);
              }
          }
    return result;
  }


  Coupling::PieceForce Coupling::piece_force(const CouplingState &state, const std::size_t k) const
  {
    const auto       &x = map.terms().exchange[k];
    const auto       &f = state.latest[k];
    const PieceField  none{};
    const PieceField &lag = x.reference == 0 ? none : x.reference == 1 ? state.old[k] : state.before_latest[k];
    const double      b   = x.gamma * x.compliance;
    PieceForce        result;
    for (unsigned int d = 0; d < dim; ++d)
      {
        result.velocity[d] = x.a[d] + b * (f.u[d] - lag.u[d]) - x.compliance * f.grad_p[d];
        result.force[d]    = x.gamma * (f.u[d] - result.velocity[d]) + x.e[d] - f.grad_p[d];
      }
    return result;
  }


  void Coupling::collect_forces(const CouplingState &state)
  {
    const auto            &terms = map.terms();
    constexpr unsigned int n     = 7;
    std::vector<double>    sums(n * state.grains.n(), 0.);
    for (std::size_t k = 0; k < terms.n_pieces(); ++k)
      {
        const PieceForce   f = piece_force(state, k);
        const unsigned int g = map.grain()[k];
        for (unsigned int d = 0; d < dim; ++d)
          {
            sums[n * g + d] += terms.shape[k].area * f.force[d];
            sums[n * g + 2 + d] += terms.shape[k].area * f.velocity[d];
          }
        sums[n * g + 4] += terms.shape[k].area;
      }
    for (std::size_t g = 0; g < state.grains.n(); ++g)
      for (unsigned int i = 0; i < 2; ++i)
        sums[n * g + 5 + i] = drag_means[2 * g + i];
    map.sum_over_ranks(sums);
    force.resize(state.grains.n());
    predicted.resize(state.grains.n());
    outside.resize(state.grains.n(), 0);
    const DragRange range = drag_law().range();
    last.force_on_grains  = {{0., 0.}};
    last.force_scale = last.force_outside_range = 0.;
    for (std::size_t g = 0; g < state.grains.n(); ++g)
      {
        force[g]     = {{sums[n * g], sums[n * g + 1]}};
        predicted[g] = {{sums[n * g + 2] / sums[n * g + 4], sums[n * g + 3] / sums[n * g + 4]}};
        for (unsigned int d = 0; d < dim; ++d)
          last.force_on_grains[d] += force[g][d];
        last.force_scale += std::hypot(force[g][0], force[g][1]);
        if (!range.contains(sums[n * g + 5] / sums[n * g + 4], sums[n * g + 6] / sums[n * g + 4]))
          {
            outside[g] = 1;
            last.force_outside_range += std::hypot(force[g][0], force[g][1]);
          }
      }
  }


  std::vector<std::array<double, 2>> Coupling::piece_velocities() const
  {
    std::vector<std::array<double, 2>> result;
    for (std::size_t k = 0; k < map.grain().size(); ++k)
      result.push_back(piece_force(*latest_state, k).velocity);
    return result;
  }


  std::vector<double> Coupling::unseen_force(const grains::Components &before,
                                             const GrainMotion        &motion,
                                             const grains::GrainLoads &loads) const
  {
    Assert(latest_state, ExcMessage("unseen_force() comes after step()."));
    const CouplingState &state = *latest_state;
    std::vector<double>  result(2 * force.size());
    for (std::size_t g = 0; g < force.size(); ++g)
      {
        const double added       = loads.mass_added_to(g) / state.dt;
        const auto   weight      = state.reduced_weight(g);
        const double coefficient = loads.drag[g] + added;
        if (std::isinf(state.grains.mass[g]))
          continue;
        result[2 * g] = loads.force[0][g] - weight[0] - force[g][0] + added * before[0][g] - coefficient * motion.vx[g];
        result[2 * g + 1] =
          loads.force[1][g] - weight[1] - force[g][1] + added * before[1][g] - coefficient * motion.vy[g];
      }
    return result;
  }


  double Coupling::typical_force() const
  {
    double weight = 0.;
    for (std::size_t g = 0; g < force.size(); ++g)
      if (const auto w = latest_state->reduced_weight(g); !std::isinf(latest_state->grains.mass[g]))
        weight += std::hypot(w[0], w[1]);
    return force.empty() ? 0. : std::max(weight, last.force_scale) / force.size();
  }


  void Coupling::set_unseen_force(const std::vector<double> &of_grains)
  {
    last.unseen_force = {{0., 0.}};
    for (std::size_t i = 0; i < of_grains.size(); ++i)
      last.unseen_force[i % 2] += of_grains[i];
  }


  std::vector<grains::GrainId> Coupling::outside_drag_range(const grains::GrainArrays &grains) const
  {
    std::vector<grains::GrainId> ids;
    for (std::size_t g = 0; g < outside.size(); ++g)
      if (outside[g])
        ids.push_back(grains.id[g]);
    return ids;
  }


  void Coupling::audit()
  {
    last.force_on_fluid = solver->interphase_force();
    if (rotation)
      last.torque_on_fluid = solver->interphase_torque();
  }
} // namespace alluvium::coupling
