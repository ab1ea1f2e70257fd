#include <alluvium/coupling/coupling.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

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
    prm.add_parameter(
      "Filter radius",
      filter_text,
      "Radius of the disc over which a grain gives to and reads from the fluid: `grain` (its own fluid radius, as in "
      "the paper) or a multiple of its contact diameter, e.g. `2 d`. On cells finer than about two grain diameters "
      "only "
      "1.5 d to 2 d give the right flux through a bed.");
    prm.add_parameter(
      "Overlap rule",
      rule_text,
      "How shape functions are integrated over the pieces of a grain: `centroid` (the paper: at the piece's centroid, "
      "exact for linear functions) or `moments` (with second moments: exact for bilinear functions on parallelograms).",
      Patterns::Selection("centroid|moments"));
    prm.add_parameter("Overlap tolerance",
                      settings.tolerance,
                      "A grain that has moved by less than this times its diameter keeps its pieces; in a bed at rest "
                      "nothing is cut. At 0 every grain that moved at all is cut.",
                      Patterns::Double(0., 0.1));
    prm.add_parameter(
      "Minimal void fraction in the drag",
      eps_floor,
      "Drag laws diverge as the void fraction goes to zero, which happens inside grains on fine meshes without a "
      "filter; below this value they see this value.",
      Patterns::Double(1e-6, 1.));
    drag_choice.add_parameters(prm, "Drag law", "disc", "Closure for the drag f = gamma (u - v) per volume of grain.");
    scheme_choice.add_parameters(prm,
                                 "Time scheme",
                                 "semi-implicit per grain",
                                 "How grains and fluid see each other's velocity within a time step.");
    prm.leave_subsection();
  }


  void Coupling::parse_parameters()
  {
    const std::string text = Utilities::trim(filter_text);
    if (text == "grain")
      settings.filter_radius = 0.;
    else
      {
        std::size_t end = 0;
        double      x   = 0.;
        try
          {
            x = std::stod(text, &end);
          }
        catch (const std::exception &)
          {}
        check_user(end > 0 && Utilities::trim(text.substr(end)) == "d" && x >= 0.5 && x <= 20.,
                   "Coupling/Filter radius: expected `grain` or a number of grain diameters between 0.5 and 20 "
                   "followed by d, such as "
                   "`2 d`; got '" +
                     filter_text + "'.");
        settings.filter_radius = x;
      }
    settings.rule = rule_text == "centroid" ? OverlapSettings::Rule::centroid : OverlapSettings::Rule::moments;
  }


  void Coupling::reinit()
  {
    map.reinit();
    eps          = space->make_nodal_field();
    latest_sweep = space->make_field();
  }


  void Coupling::update_void_fraction(const grains::GrainArrays &grains)
  {
    const auto timer = solver->timers.scope("fluid: overlap");
    if (!map.cut(grains, settings))
      {
        last = of_void_fraction;
        return;
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
  }


  void Coupling::step(const fluid::BoundaryConditions<dim> &boundary_conditions,
                      const grains::GrainArrays            &grains,
                      const std::vector<std::uint8_t>      &touched,
                      const double                          dt,
                      const bool                            fixed,
                      grains::GrainLoads                   &loads)
  {
    update_void_fraction(grains);
    CouplingState state{
      grains, touched, map, dt, {{solver->gravity[0], solver->gravity[1]}}, solver->properties.density, {}, {}, {}};
    state.old    = evaluate(map, *space, solver->old());
    state.latest = state.old;
    find_drag(state);

    // grains that cannot move need no prediction
    const auto        frozen = Registry<TimeScheme>::entries().at("implicit drag").create();
    const TimeScheme &scheme = fixed ? *frozen : scheme_choice.get();

    auto &exchange = map.terms().exchange;
    scheme.exchange_terms(state, 0, exchange);
    fluid::VansProblem<dim> problem{};
    problem.dt            = dt;
    problem.void_fraction = &eps;
    problem.solid         = &map.terms();
    problem.reference     = {{nullptr, &solver->old().block(0), &latest_sweep.block(0)}};
    solver->begin_step(boundary_conditions, problem);
    solver->solve();
    last.n_iterations = solver->last_report().n_iterations;
    last.n_loose      = solver->last_report().loose;
    for (unsigned int sweep = 1; sweep < scheme.n_sweeps(); ++sweep)
      {
        state.latest = evaluate(map, *space, solver->solution());
        solver->solve_again([&](auto &) {
          latest_sweep = solver->solution();
          latest_sweep.update_ghost_values();
          scheme.exchange_terms(state, sweep, exchange);
        });
        last.n_iterations += solver->last_report().n_iterations;
        last.n_loose += solver->last_report().loose;
      }
    state.latest = evaluate(map, *space, solver->solution());
    collect_forces(state);
    loads.reset(grains.n());
    scheme.loads(state, force, loads);
  }


  void Coupling::find_drag(CouplingState &state)
  {
    const auto        &terms = map.terms();
    const DragLaw     &law   = drag_choice.get();
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
          s.slip     = std::hypot(state.old[k].u[0] - state.grains.vx[g], state.old[k].u[1] - state.grains.vy[g]);
          s.diameter = 2. * state.grains.fluid_radius[g];
          drag_means[2 * g] += terms.shape[k].area * s.eps;
          drag_means[2 * g + 1] += terms.shape[k].area * s.reynolds();
          s.eps          = std::max(s.eps, eps_floor);
          state.gamma[k] = law.gamma(s);
        }
  }


  void Coupling::collect_forces(const CouplingState &state)
  {
    const auto                   &terms = map.terms();
    constexpr unsigned int        n     = 7;
    std::vector<double>           sums(n * state.grains.n(), 0.);
    const std::vector<PieceField> lag_of_sweep = evaluate(map, *space, latest_sweep);
    const PieceField              none{};
    for (std::size_t k = 0; k < terms.n_pieces(); ++k)
      {
        const auto        &x   = terms.exchange[k];
        const auto        &f   = state.latest[k];
        const PieceField  &lag = x.reference == 0 ? none : x.reference == 1 ? state.old[k] : lag_of_sweep[k];
        const double       b   = x.gamma * x.compliance;
        const unsigned int g   = map.grain()[k];
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double v = x.a[d] + b * (f.u[d] - lag.u[d]) - x.compliance * f.grad_p[d];
            sums[n * g + d] += terms.shape[k].area * (x.gamma * (f.u[d] - v) + x.e[d] - f.grad_p[d]);
            sums[n * g + 2 + d] += terms.shape[k].area * v;
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
    for (std::size_t g = 0; g < state.grains.n(); ++g)
      {
        force[g]     = {{sums[n * g], sums[n * g + 1]}};
        predicted[g] = {{sums[n * g + 2] / sums[n * g + 4], sums[n * g + 3] / sums[n * g + 4]}};
        for (unsigned int d = 0; d < dim; ++d)
          last.force_on_grains[d] += force[g][d];
        last.force_scale += std::hypot(force[g][0], force[g][1]);
        if (!range.contains(sums[n * g + 5] / sums[n * g + 4], sums[n * g + 6] / sums[n * g + 4]))
          outside[g] = 1;
      }
  }


  void Coupling::add_grain_response(const grains::GrainArrays &grains, const grains::GrainLoads &loads)
  {
    std::array<double, 2> sum{};
    for (std::size_t g = 0; g < grains.n(); ++g)
      {
        sum[0] += loads.drag[g] * (grains.vx[g] - predicted[g][0]);
        sum[1] += loads.drag[g] * (grains.vy[g] - predicted[g][1]);
      }
    last.momentum_not_received = std::hypot(sum[0], sum[1]);
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
  }
} // namespace alluvium::coupling
