#include <alluvium/fluid/open_boundary_flow.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/utilities/magnitudes.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  template <int dim>
  VansSolver<dim>::VansSolver(const FluidSpace<dim> &space)
    : assembler(space)
    , space(&space)
    , current()
  {}


  template <int dim>
  void VansSolver<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Fluid");
    prm.add_parameter("Density",
                      properties.density,
                      "Density rho of the fluid [kg/m^3].",
                      Patterns::Double(1e-6, magnitudes::largest_density));
    prm.add_parameter("Viscosity",
                      properties.viscosity,
                      "Dynamic viscosity eta of the fluid [Pa s].",
                      Patterns::Double(1e-12, magnitudes::largest_viscosity));
    prm.add_parameter(
      "Convection",
      discretisation.convection,
      "Keep u.grad u (and its stabilisation). Without it the fluid obeys the volume-averaged Stokes equations.");
    prm.add_parameter(
      "Lumped drag",
      discretisation.lumped_drag,
      "Row-sum lump the drag in the momentum equation. Needed for the right flux on meshes finer than a grain; "
      "costs pressure accuracy where drag varies strongly within a cell.");
    const std::string terms = "Open boundary terms";
    prm.declare_entry(
      terms,
      "traction, upwinding, advection, tangential, backflow",
      Patterns::MultipleSelection("none|traction|upwinding|advection|tangential|backflow"),
      "What is done where the pressure is given, for comparisons (doc/theory/open-boundaries.md). `traction`: viscous "
      "traction "
      "of developed flow; `upwinding`: none across the boundary; `advection`: none from outside; `tangential`: flow "
      "enters at right angles; `backflow`: what comes back loses its kinetic energy. Leave one out and flows that are "
      "exact or stable are so no longer.");
    prm.add_action(terms, [this](const std::string &value) {
      const auto names = Utilities::split_string_list(value);
      const auto has   = [&](const char *term) { return std::find(names.begin(), names.end(), term) != names.end(); };
      discretisation.open_boundary = {
        has("traction"), has("upwinding"), has("advection"), has("tangential"), has("backflow")};
    });
    driving.add_parameters(prm);
    linear_solver.add_parameters(prm);
    prm.leave_subsection();
  }


  template <int dim>
  void VansSolver<dim>::reinit()
  {
    linear_solver.clear(); // first: it looks at the assembler's matrix
    assembler.reinit();
    given.clear();
    boundary_fluxes.clear();
    current.given_fluxes = nullptr;
    auto &volumes        = linear_solver.scales.volumes;
    space->reinit_field(volumes);
    for (const CellData<dim> &cell : space->cells())
      for (unsigned int v = 0; v < space->n_nodes_per_cell(); ++v)
        {
          const double share = cell.measure / space->n_nodes_per_cell();
          volumes.block(1).local_element(cell.pressure[v]) += share;
          for (unsigned int d = 0; d < dim; ++d)
            volumes.block(0).local_element(cell.velocity[v][d]) += share;
        }
    volumes.compress(VectorOperation::add);
    for (BlockVector *field : {&iterate, &previous, &residual, &increment, &product, &known})
      space->reinit_field(*field);
    iterate.update_ghost_values();
    previous.update_ghost_values();
  }


  template <int dim>
  void VansSolver<dim>::choose_datum(const BoundaryConditions<dim> &boundary_conditions)
  {
    pressure_datum = space->boundary().pressure_datum(boundary_conditions, background_gradient());
  }


  template <int dim>
  std::map<types::boundary_id, double>
  VansSolver<dim>::pressure_deficits(const BoundaryConditions<dim> &boundary_conditions, const BlockVector &start) const
  {
    if (!discretisation.convection || !boundary_conditions.total_pressure_on_inflow())
      return {};
    return dynamic_pressures(*space, properties.density, start);
  }


  template <int dim>
  void VansSolver<dim>::update_given(const BoundaryConditions<dim> &boundary_conditions, const Vector &void_fraction)
  {
    given.update(*space, boundary_conditions, void_fraction);
    driving.set_time(boundary_conditions.current_time());
  }


  template <int dim>
  std::array<double, dim> VansSolver<dim>::drive() const
  {
    const Tensor<1, dim>    sum = unsupported_weight() + driving.body_force();
    std::array<double, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = sum[d];
    return result;
  }


  template <int dim>
  bool VansSolver<dim>::has_boundary_values(const BoundaryConditions<dim> &boundary_conditions,
                                            const Vector                  &void_fraction)
  {
    update_given(boundary_conditions, void_fraction);
    const bool same_values = space->boundary().has_boundary_values(boundary_conditions,
                                                                   background_gradient(),
                                                                   pressure_datum,
                                                                   pressure_deficits(boundary_conditions, iterate),
                                                                   given.node_values(),
                                                                   iterate);
    return same_values && !boundary_conditions.terms_depend_on_time() &&
           (!has_begun || (drive() == current.drive && background_gradient() == latest_gradient));
  }


  template <int dim>
  std::map<types::boundary_id, double> VansSolver<dim>::given_fluxes(const BoundaryConditions<dim> &boundary_conditions,
                                                                     const Vector                  &void_fraction)
  {
    has_boundary_values(boundary_conditions, void_fraction); // looks at all of them
    return given.boundary_fluxes(*space, boundary_conditions);
  }


  template <int dim>
  void VansSolver<dim>::begin_step(const BoundaryConditions<dim> &boundary_conditions, const VansProblem<dim> &problem)
  {
    current                = problem;
    given_inertia          = problem.inertia ? std::make_unique<BlockVector>(*problem.inertia) : nullptr;
    current.inertia        = given_inertia.get();
    current.fluid          = properties;
    current.discretisation = discretisation;
    current.old            = &previous;
    if (current.dt > 1.2 * dt_of_preconditioner || current.dt < dt_of_preconditioner / 1.2)
      {
        linear_solver.clear();
        dt_of_preconditioner = current.dt;
      }
    linear_solver.scales.inertia   = properties.density / current.dt;
    linear_solver.scales.viscosity = properties.viscosity;
    update_given(boundary_conditions, *current.void_fraction);
    current.boundary_conditions = &boundary_conditions;
    current.given_fluxes        = &given.face_fluxes();
    current.drive               = drive();
    current.background_gradient = background_gradient();
    current.pressure_datum      = pressure_datum;
    latest_gradient             = background_gradient();
    has_begun                   = true;
    boundary_fluxes             = given.boundary_fluxes(*space, boundary_conditions);
    space->boundary().apply_boundary_values(boundary_conditions,
                                            background_gradient(),
                                            pressure_datum,
                                            pressure_deficits(boundary_conditions, previous),
                                            given.node_values(),
                                            iterate);
  }


  template <int dim>
  void VansSolver<dim>::solve()
  {
    Assert(current.old == &previous && current.dt > 0., ExcMessage("solve() comes after begin_step()."));
    {
      const auto timer = timers.scope("fluid: assembly");
      assembler.assemble(current, iterate, residual, known);
    }
    report = {};
    solve_increment();
  }


  template <int dim>
  void VansSolver<dim>::solve_with_new_known_terms()
  {
    Assert(current.old == &previous && current.dt > 0., ExcMessage("This comes after solve()."));
    // the residual at the new iterate, A being the same
    residual -= known;
    assembler.known_interphase(current, known);
    residual += known;
    report = {};
    solve_increment();
  }


  template <int dim>
  void VansSolver<dim>::solve_increment()
  {
    const auto timer = timers.scope("fluid: linear solver");
    // the terms' sizes are known from the last iterate; if they turn out much smaller, the tolerance was too loose:
    // once more
    for (unsigned int attempt = 0; attempt < 3; ++attempt)
      {
        const std::array<double, 2> scale = term_scale();
        if (scale[0] == 0.)
          return; // nothing moves and nothing pushes
        const LinearSolverReport solve = linear_solver.solve(
          assembler.matrix(), residual, scale, space->constraints(), current.tolerance_factor, increment);
        report.residual = solve.residual;
        report.n_iterations += solve.n_iterations;
        report.loose  = report.loose || solve.loose;
        report.direct = report.direct || solve.direct;
        if (solve.loose)
          attempt = 3; // no better with a second try
        if (solve.n_iterations == 0)
          return;
        assembler.matrix().vmult(product, increment);
        residual -= product;
        iterate.zero_out_ghost_values();
        space->constraints().distribute(increment);
        iterate += increment;
        iterate.update_ghost_values();
        const std::array<double, 2> found = term_sizes();
        if (found[0] > 0.2 * scale[0] && found[1] > 0.2 * scale[1])
          return;
      }
  }


  template <int dim>
  double VansSolver<dim>::cell_length() const
  {
    return std::sqrt(
      Utilities::MPI::max(space->cells().empty() ? 0. : space->cells().front().measure, space->communicator()));
  }


  template <int dim>
  std::array<double, 2> VansSolver<dim>::term_sizes() const
  {
    std::array<double, 2> size = assembler.term_norms(current, iterate);
    // Where no pressure drives the flow, inertia and friction are still there, and their round-off. They are larger
    // than the other terms in most flows, and would be too loose a measure.
    constexpr double part           = 1e-5;
    const double     length         = cell_length();
    const double     force_per_flux = properties.density / current.dt * length + properties.viscosity / length;
    size[0]                         = std::max(size[0], part * force_per_flux * size[1]);
    return size;
  }


  template <int dim>
  std::array<double, 2> VansSolver<dim>::term_scale() const
  {
    std::array<double, 2> scale = term_sizes();
    // from rest no term has a size yet: the residual itself gives the first, u = p dt / (rho h) relates the two
    scale[0]                    = std::max(scale[0], residual.block(0).l2_norm());
    const double flux_per_force = current.dt / (properties.density * cell_length());
    if (scale[0] == 0.)
      scale[0] = residual.block(1).l2_norm() / flux_per_force;
    scale[1] = std::max(scale[1], residual.block(1).l2_norm());
    // nor has a flux that is not there yet: below this, round-off alone would be above the tolerance
    constexpr double nothing = 1e-10, little = 1e-4;
    if (scale[1] < nothing * scale[0] * flux_per_force)
      scale[1] = little * scale[0] * flux_per_force;
    return scale;
  }


  template <int dim>
  void VansSolver<dim>::accept()
  {
    previous = iterate;
    previous.update_ghost_values();
  }


  template <int dim>
  void VansSolver<dim>::take_back()
  {
    iterate = previous;
    iterate.update_ghost_values();
  }


  template <int dim>
  void VansSolver<dim>::set_solution(const BlockVector &field)
  {
    iterate  = field;
    previous = field;
    iterate.update_ghost_values();
    previous.update_ghost_values();
  }


  template <int dim>
  void VansSolver<dim>::save_history(ByteWriter &writer) const
  {
    writer.put(dt_of_preconditioner);
    linear_solver.save(writer);
  }


  template <int dim>
  void VansSolver<dim>::load_history(ByteReader &reader)
  {
    dt_of_preconditioner = reader.get<double>();
    linear_solver.load(reader, assembler.matrix());
  }


  template class VansSolver<2>;
} // namespace alluvium::fluid
