#include <alluvium/coupling/coupled_solve.h>

#include <deal.II/base/parameter_handler.h>

namespace alluvium::coupling
{
  using namespace dealii;

  void SolveCounts::add(const SolveCounts &other)
  {
    n_iterations += other.n_iterations;
    n_loose += other.n_loose;
    n_direct += other.n_direct;
  }


  CoupledSolve::CoupledSolve(const fluid::FluidSpace<dim> &space,
                             fluid::VansSolver<dim>       &solver,
                             OverlapMap                   &map,
                             const fluid::Vector          &eps)
    : space(&space)
    , solver(&solver)
    , map(&map)
    , eps(&eps)
  {}


  void CoupledSolve::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Added mass coefficient",
                      added_mass,
                      "C_m of the added mass C_m rho V (Du/Dt - dv/dt): 0.5 for spheres, 1 for discs; 0: none. Needs a "
                      "semi-implicit time scheme.",
                      Patterns::Double(0.));
    prm.add_parameter("Rotation",
                      rotation,
                      "Couple the grains' spin with the fluid: drag sees the velocity of every point of a grain, and "
                      "turns the grain. Without it the fluid exerts no torque.");
    drag.add_parameters(prm);
  }


  void CoupledSolve::reinit()
  {
    space->reinit_field(reference_field);
    reference_field.update_ghost_values(); // it may be read before there is one
  }


  void CoupledSolve::prepare(CouplingState &state)
  {
    state.gravity       = {{solver->gravity[0], solver->gravity[1]}};
    state.fluid_density = solver->properties.density;
    state.unsupported   = {{solver->unsupported_weight()[0], solver->unsupported_weight()[1]}};
    evaluate(*map, *space, solver->old(), state.old);
    state.latest = state.old;
    if (rotation)
      state.old_gradient = state.latest_gradient = velocity_gradients(*map, *space, solver->old());
    drag.find(*space, *eps, solver->properties, state);
    auto &spin = map->terms().spin;
    spin.resize(map->arms().size());
    for (std::size_t k = 0; k < spin.size(); ++k)
      spin[k] = {map->arms()[k].moments, map->arms()[k].arm, state.gamma[k]};
    find_acceleration(state);
  }


  void CoupledSolve::find_acceleration(CouplingState &state) const
  {
    if (added_mass == 0.)
      return;
    state.added_density = added_mass * solver->properties.density;
    state.acceleration.resize(state.n_pieces());
    const auto gradient = velocity_gradients(*map, *space, solver->old());
    for (std::size_t k = 0; k < state.n_pieces(); ++k)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const auto &u            = state.old[k].u;
          state.acceleration[k][d] = -u[d] / state.dt;
          if (solver->discretisation.convection)
            state.acceleration[k][d] += u[0] * gradient[k][d][0] + u[1] * gradient[k][d][1];
        }
  }


  SolveCounts CoupledSolve::solve(const fluid::BoundaryConditions<dim> &boundary_conditions,
                                  const TimeScheme                     &scheme,
                                  fluid::VansProblem<dim>               problem,
                                  CouplingState                        &state)
  {
    solutions.clear();
    auto &exchange = map->terms().exchange;
    scheme.exchange_terms(state, 0, exchange);
    problem.void_fraction = eps;
    problem.solid         = &map->terms();
    problem.reference     = {{nullptr, &solver->old().block(0), &reference_field.block(0)}};
    solver->begin_step(boundary_conditions, problem);
    solver->solve();
    SolveCounts counts = latest_counts();
    for (unsigned int sub_iteration = 1; sub_iteration < scheme.n_sub_iterations(); ++sub_iteration)
      {
        sample_fields(solver->solution(), state);
        solver->solve_again([&](auto &) {
          reference_field = solver->solution();
          reference_field.update_ghost_values();
          scheme.exchange_terms(state, sub_iteration, exchange);
        });
        counts.add(latest_counts());
      }
    sample_fields(solver->solution(), state);
    return counts;
  }


  SolveCounts
  CoupledSolve::solve_again(const TimeScheme &scheme, const std::vector<double> &weights, CouplingState &state)
  {
    Assert(weights.size() <= solutions.size() + 1, ExcDimensionMismatch(weights.size(), solutions.size() + 1));
    solutions.push_back(solver->solution());
    solutions.erase(solutions.begin(), solutions.end() - weights.size());
    solver->solve_again([&](auto &) {
      reference_field = 0.;
      for (std::size_t i = 0; i < weights.size(); ++i)
        reference_field.add(weights[i], solutions[i]);
      reference_field.update_ghost_values();
      sample_fields(reference_field, state);
      scheme.exchange_terms(state, scheme.n_sub_iterations(), map->terms().exchange);
    });
    sample_fields(solver->solution(), state);
    return latest_counts();
  }


  SolveCounts CoupledSolve::latest_counts() const
  {
    const fluid::LinearSolverReport &report = solver->last_report();
    return {report.n_iterations, report.loose, report.direct};
  }


  void CoupledSolve::sample_fields(const fluid::BlockVector &field, CouplingState &state) const
  {
    state.before_latest.swap(state.latest);
    evaluate(*map, *space, field, state.latest);
    if (!rotation)
      return;
    state.before_latest_gradient.swap(state.latest_gradient);
    state.latest_gradient = velocity_gradients(*map, *space, field);
  }
} // namespace alluvium::coupling
