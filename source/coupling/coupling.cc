#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/flow_after_remeshing.h>
#include <alluvium/coupling/piece_force.h>
#include <alluvium/coupling/void_fraction.h>

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
    , solve(space, solver, map, eps)
  {}


  void Coupling::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Coupling");
    overlap_parameters.add_parameters(prm);
    solve.add_parameters(prm);
    scheme_choice.add_parameters(
      prm, "Time scheme", "iterated", "How grains and fluid see each other's velocity within a time step.");
    prm.leave_subsection();
  }


  void Coupling::parse_parameters()
  {
    scheme_choice.parse_parameters();
    solve.parse_parameters();
    settings           = overlap_parameters.settings();
    settings.keep_arms = solve.couples_rotation();
    check_user(
      solve.added_mass_coefficient() == 0. || scheme_choice.get().predicts_acceleration(),
      "Coupling/Added mass coefficient: added mass needs a time scheme that predicts how the grains accelerate, "
      "such as `semi-implicit per grain`; '" +
        scheme_choice.name() + "' does not.");
  }


  void Coupling::reinit()
  {
    map.reinit();
    is_steady = resumes = has_step = false;
    space->reinit_nodal_field(eps);
    solve.reinit();
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
    last.clipped_volume = lumped_void_fraction(map.terms(), *space, eps);
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
    outside_range.remove_grains(keep);
    is_steady = resumes = has_step = false;
    forces.clear(); // until the step finds them anew
    forget_positions();
  }


  void Coupling::save(ByteWriter                      &writer,
                      const grains::GrainArrays       &grains,
                      const std::vector<std::uint8_t> &touched,
                      const double                     dt,
                      const bool                       fixed) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      writer.put(map.position_of_cut()[d]);
    writer.put(outside_range.flags());
    writer.put<std::uint8_t>(is_steady && inputs_of(grains, touched, relevant_dt(dt, fixed), fixed) == last_inputs);
  }


  void Coupling::load(ByteReader &reader, const grains::GrainArrays &grains)
  {
    grains::GrainArrays then = grains;
    for (unsigned int d = 0; d < dim; ++d)
      then.position[d] = reader.get_vector<double>();
    outside_range.set_flags(reader.get_vector<std::uint8_t>());
    const bool same = reader.get<std::uint8_t>() != 0;
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
    const CouplingReport before = last;
    const bool           moved  = update_void_fraction(grains);
    const auto           inputs = [&] { return inputs_of(grains, touched, relevant_dt(dt, fixed), fixed); };
    const bool           same_boundary_values = solver->has_boundary_values(boundary_conditions, eps);
    if (!moved && same_boundary_values && is_steady && inputs() == last_inputs)
      {
        last              = before;
        last.steady       = true;
        last.n_iterations = last.n_loose = last.n_direct = 0; // those of reinitialise_flow() are counted
        loads                                            = last_loads;
        return;
      }
    pieces.dt      = dt;
    pieces.touched = touched;
    CouplingState state(grains, map, std::move(pieces));
    solve.prepare(state);

    // grains that cannot move need no prediction
    const TimeScheme       &scheme = fixed ? frozen_scheme() : scheme_choice.get();
    fluid::VansProblem<dim> problem{};
    problem.dt        = dt;
    last.n_iterations = last.n_loose = last.n_direct = 0;
    count(solve.solve(boundary_conditions, scheme, problem, state));
    // fixed grains, and no inertia: the flow of the last step is only where the search begins
    finds_stationary = fixed && !solver->discretisation.inertia;
    const bool is_stationary =
      finds_stationary && find_stationary(boundary_conditions, scheme, problem, same_boundary_values, state);
    find_loads(scheme, state, loads);
    is_steady = is_stationary || (same_boundary_values && last.n_iterations == 0);
    if (is_steady)
      last_inputs = inputs();
    last.steady = resumes && !moved && is_steady;
    resumes     = false;
    count(std::exchange(of_reinitialisation, {}));
    pieces   = std::move(state);
    has_step = true;
  }


  bool Coupling::find_stationary(const fluid::BoundaryConditions<dim> &boundary_conditions,
                                 const TimeScheme                     &scheme,
                                 fluid::VansProblem<dim>               problem,
                                 const bool                            to_the_end,
                                 CouplingState                        &state)
  {
    constexpr unsigned int most  = 20;
    constexpr double       loose = 1e-4; // relative residual: the next step goes on from there
    if (!to_the_end)
      problem.tolerance_factor = std::max(1., loose / solver->linear_solver.tolerance);
    flow_before = solver->old();
    flow_before.update_ghost_values();
    for (unsigned int n = 0; n < most; ++n)
      {
        solver->accept(); // drag and convection are those of the flow that was found
        solve.prepare(state);
        const SolveCounts counts = solve.solve(boundary_conditions, scheme, problem, state);
        count(counts);
        if (counts.n_iterations == 0)
          return to_the_end;
      }
    return false;
  }


  void Coupling::repeat(const grains::GrainArrays &grains,
                        const GrainMotion         &corrected,
                        const std::vector<double> &weights,
                        grains::GrainLoads        &loads)
  {
    Assert(has_step, ExcMessage("repeat() comes after step()."));
    Assert(corrected.velocity[0].size() == grains.n(), ExcDimensionMismatch(corrected.velocity[0].size(), grains.n()));
    Assert(map.is_cut_where(grains), ExcMessage("The grains of step() must be where they were."));
    const TimeScheme &scheme = scheme_choice.get();
    CouplingState     state(grains, map, std::move(pieces));
    state.corrected_motion = &corrected;
    count(solve.solve_again(scheme, weights, state));
    find_loads(scheme, state, loads);
    pieces    = std::move(state);
    is_steady = false;
  }


  void Coupling::count(const SolveCounts &counts)
  {
    last.n_iterations += counts.n_iterations;
    last.n_loose += counts.n_loose;
    last.n_direct += counts.n_direct;
  }


  void Coupling::find_loads(const TimeScheme &scheme, const CouplingState &state, grains::GrainLoads &loads)
  {
    forces.collect(state, scheme, solve.drag, *space, outside_range, loads);
    const ForceTotals &totals = forces.totals();
    last.force_on_grains      = totals.force;
    last.force_scale          = totals.scale;
    last.force_outside_range  = totals.outside_range;
    if (state.couples_spin())
      last.torque_on_grains = totals.torque;
    last_loads = loads;
  }


  bool Coupling::reinitialise_flow(const fluid::BoundaryConditions<dim> &boundary_conditions,
                                   const grains::GrainArrays            &grains,
                                   const double                          dt,
                                   const fluid::BlockVector             &before,
                                   const double                          share)
  {
    is_steady = resumes = false;
    if (!solver->discretisation.inertia)
      return false; // the next step does not ask what the flow was
    const FlowChange change = flow_change(*space, *solver, before, grains);
    // what interpolation leaves in a few cells is less than what finding the flow anew does to accelerating grains
    constexpr double small_share = 0.2;
    if (!change.is_slow() && share < small_share)
      return false;

    update_void_fraction(grains);
    PieceState fresh;
    fresh.dt = dt;
    fresh.touched.assign(grains.n(), 0);
    CouplingState state(grains, map, std::move(fresh));
    solve.prepare(state);
    of_reinitialisation.add(find_flow_after_remeshing(
      solve, *solver, boundary_conditions, frozen_scheme(), change, before, dt, state, space->communicator()));
    return true;
  }


  std::vector<std::array<double, 2>> Coupling::piece_velocities() const
  {
    std::vector<std::array<double, 2>> result;
    for (std::size_t k = 0; k < map.grain().size(); ++k)
      result.push_back(piece_force(map, pieces, k).velocity);
    return result;
  }


  std::vector<double> Coupling::momentum_defect(const grains::GrainArrays &grains,
                                                const grains::Components  &before,
                                                const GrainMotion         &motion,
                                                const grains::GrainLoads  &loads) const
  {
    Assert(has_step, ExcMessage("momentum_defect() comes after step()."));
    const auto         &of_fluid = forces.force();
    std::vector<double> result(2 * of_fluid.size());
    for (std::size_t g = 0; g < of_fluid.size(); ++g)
      {
        if (std::isinf(grains.mass[g]))
          continue;
        const double added       = loads.mass_added_to(g) / pieces.dt;
        const auto   weight      = pieces.submerged_weight(grains, g);
        const double coefficient = loads.drag[g] + added;
        for (unsigned int d = 0; d < dim; ++d)
          result[2 * g + d] =
            loads.force[d][g] - weight[d] - of_fluid[g][d] + added * before[d][g] - coefficient * motion.velocity[d][g];
      }
    return result;
  }


  double Coupling::typical_force(const grains::GrainArrays &grains) const
  {
    double            weight = 0.;
    const std::size_t n      = forces.force().size();
    for (std::size_t g = 0; g < n; ++g)
      if (const auto w = pieces.submerged_weight(grains, g); !std::isinf(grains.mass[g]))
        weight += std::hypot(w[0], w[1]);
    return n == 0 ? 0. : std::max(weight, last.force_scale) / n;
  }


  void Coupling::set_momentum_defect(const std::vector<double> &of_grains)
  {
    last.momentum_defect = {{0., 0.}};
    for (std::size_t i = 0; i < of_grains.size(); ++i)
      last.momentum_defect[i % 2] += of_grains[i];
  }


  void Coupling::audit()
  {
    last.force_on_fluid = solver->interphase_force();
    last.force_parts    = Utilities::MPI::sum(size_of_parts(map, pieces), space->communicator());
    if (solve.couples_rotation())
      last.torque_on_fluid = solver->interphase_torque();
  }
} // namespace alluvium::coupling
