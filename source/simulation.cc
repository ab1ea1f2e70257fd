#include <alluvium/coupling/contact_iteration.h>
#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/line_average.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/grains/contact_stepper.h>
#include <alluvium/grains/grain_checkpoint.h>
#include <alluvium/grains/grain_store.h>
#include <alluvium/grains/packing.h>
#include <alluvium/mesh/adaptivity.h>
#include <alluvium/mesh/bed_faces.h>
#include <alluvium/mesh/domain.h>
#include <alluvium/mesh/field_transfer.h>
#include <alluvium/mesh/fluid_checkpoint.h>
#include <alluvium/observers/fluid_output.h>
#include <alluvium/observers/observer.h>
#include <alluvium/observers/output_folder.h>
#include <alluvium/scene/grain_setup.h>
#include <alluvium/simulation.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/progress.h>
#include <alluvium/utilities/signals.h>
#include <alluvium/utilities/timers.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/reference_cell.h>
#include <deal.II/grid/tria.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace alluvium
{
  using namespace dealii;

  namespace
  {
    constexpr int dim = 2;

    /** The parameters of the loop itself. */
    struct RunParameters
    {
      double end_time = 1., time_step = 1e-3, output_interval = 0.05, statistics_interval = 0.01,
             checkpoint_interval = 0.;
      std::string  gravity_text = "0, -9.81", model = "volume-averaged", format = "vtu", progress = "automatic";
      bool         restart   = false;
      unsigned int precision = 10;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter("Gravity",
                          gravity_text,
                          "Acceleration of gravity, x and y [m/s^2].",
                          Patterns::List(Patterns::Double(), 2, 2));
        prm.enter_subsection("Time");
        prm.add_parameter("End time", end_time, "When the run ends [s].", Patterns::Double(0.));
        prm.add_parameter("Time step",
                          time_step,
                          "Step of the fluid and of the coupling [s]; contacts take sub-steps.",
                          Patterns::Double(1e-12));
        prm.leave_subsection();
        prm.enter_subsection("Fluid");
        prm.add_parameter(
          "Model",
          model,
          "`volume-averaged`: the volume-averaged Navier-Stokes equations between and around the grains; `none`: dry "
          "grains, for which no mesh and no matrix is made.",
          Patterns::Selection("volume-averaged|none"));
        prm.leave_subsection();
        prm.enter_subsection("Output");
        prm.add_parameter("Interval of pictures",
                          output_interval,
                          "Time between two outputs of the fields for ParaView [s]; 0: none.",
                          Patterns::Double(0.));
        prm.add_parameter("Interval of statistics",
                          statistics_interval,
                          "Time between two rows of statistics.csv [s]; 0: every step.",
                          Patterns::Double(0.));
        prm.add_parameter("Interval of checkpoints",
                          checkpoint_interval,
                          "Time between two checkpoints [s]; 0: only when the run is interrupted.",
                          Patterns::Double(0.));
        prm.add_parameter("Format",
                          format,
                          "Files of the fluid's fields: .vtu, or HDF5 with XDMF for big runs.",
                          Patterns::Selection("vtu|hdf5"));
        prm.add_parameter("Digits", precision, "Significant digits in statistics.csv.", Patterns::Integer(3, 17));
        prm.add_parameter("Restart", restart, "Continue from the checkpoint in the output folder.");
        prm.add_parameter(
          "Progress", progress, "How to show progress.", Patterns::Selection("automatic|bar|lines|silent"));
        prm.leave_subsection();
      }

      std::array<double, 2> gravity() const
      {
        const auto x = Utilities::string_to_double(Utilities::split_string_list(gravity_text));
        return {{x[0], x[1]}};
      }
    };

    /** Whether a multiple of @p interval lies in (time - dt, time]. */
    bool is_due(const double time, const double dt, const double interval)
    {
      const double eps = 1e-6 * dt;
      return interval == 0. || std::floor((time + eps) / interval) > std::floor((time - dt + eps) / interval);
    }
  } // namespace


  class Simulation::Implementation
  {
  public:
    explicit Implementation(MPI_Comm communicator);

    void add_parameters(ParameterHandler &prm);
    void build_scene(const std::string &directory);
    void report_scene(std::ostream &out) const;
    void run(const ParameterHandler &prm, const std::string &directory);

  private:
    mesh::RefinementContext refinement_context() const;
    void                    count_cell_weights();
    void                    find_initial_mesh();
    bool                    adapt_mesh();
    void                    step();
    void                    observe();
    void                    write_statistics();
    void                    write_pictures();
    void                    open_output();
    void                    load_by_gravity();
    void                    find_initial_contact_forces();
    void                    write_checkpoint();
    void                    read_checkpoint();
    void                    conclude(const bool interrupted);
    void                    warn_of_drag_range();
    double                  head() const;
    observers::Snapshot     snapshot() const;
    std::string             checkpoint_folder() const { return folder.file("checkpoint"); }

    const MPI_Comm communicator;
    const bool     speaks;
    RunParameters  parameters;

    // the rooms; those of the fluid stay empty in a dry scene
    mesh::Domain<dim>                         domain;
    mesh::Adaptivity<dim>                     adaptivity;
    mesh::CellWeights                         cell_weights; // before the mesh, which asks it
    std::unique_ptr<Triangulation<dim>>       triangulation;
    fluid::BoundaryConditions<dim>            boundary_conditions;
    fluid::FluidSpace<dim>                    space;
    fluid::VansSolver<dim>                    solver;
    coupling::Coupling                        coupling;
    scene::GrainSetup                         grain_setup;
    grains::GrainStore                        store;
    grains::ContactStepper                    contacts;
    coupling::ContactIteration                contact_iteration{coupling, contacts, timers};
    PluginChoice<observers::Observer>         observer_choice;
    std::unique_ptr<mesh::FieldTransfer<dim>> transfer;

    // the state
    bool                      has_fluid = true, grains_move = true;
    std::array<double, 2>     gravity{};
    grains::GrainArrays       grains;
    grains::GrainLoads        loads;
    std::vector<std::uint8_t> touched; // by others in the last step
    grains::ContactReport     contact_report;
    mesh::BedFaces            initial_bed;
    double                    time = 0., coarse_cell_size = 0.;
    unsigned int              n_steps = 0;

    // the output
    observers::OutputFolder                 folder;
    std::vector<observers::Observer *>      observing;
    std::unique_ptr<observers::FluidView>   fluid_view;
    std::unique_ptr<observers::Statistics>  statistics;
    std::unique_ptr<observers::Summary>     summary;
    std::unique_ptr<observers::FieldSeries> fluid_pictures, grain_pictures;
    Timers                                  timers;
    std::map<std::string, double>           counts; // steps, sweeps, iterations ...
  };


  Simulation::Implementation::Implementation(MPI_Comm communicator)
    : communicator(communicator)
    , speaks(Utilities::MPI::this_mpi_process(communicator) == 0)
    , solver(space)
    , coupling(space, solver)
    , store(communicator)
  {}


  void Simulation::Implementation::add_parameters(ParameterHandler &prm)
  {
    parameters.add_parameters(prm);
    domain.add_parameters(prm);
    adaptivity.add_parameters(prm);
    solver.add_parameters(prm);
    boundary_conditions.add_parameters(prm);
    coupling.add_parameters(prm);
    grain_setup.add_parameters(prm);
    prm.enter_subsection("Contacts");
    contacts.add_parameters(prm);
    prm.leave_subsection();
    prm.enter_subsection("Output");
    folder.add_parameters(prm);
    observer_choice.add_parameters(prm,
                                   "Observers",
                                   "head, motion, support, flux, bed, audit",
                                   "What to measure; those that a scene gives nothing to are left out.",
                                   true);
    prm.leave_subsection();
  }


  void Simulation::Implementation::build_scene(const std::string &directory)
  {
    gravity     = parameters.gravity();
    has_fluid   = parameters.model != "none";
    grains_move = !grain_setup.fixed();
    for (unsigned int d = 0; d < dim; ++d)
      solver.gravity[d] = gravity[d];
    coupling.parse_parameters();

    domain.initialize(communicator, directory);
    const auto walls = grain_setup.walls(domain);
    contacts.set_walls(walls);
    contacts.set_periodicity(domain.periodicity());
    contacts.set_communicator(communicator);
    grains                            = grain_setup.make(communicator, domain, walls, gravity, directory);
    const std::array<double, 2> lower = {{domain.lower()[0], domain.lower()[1]}},
                                upper = {{domain.upper()[0], domain.upper()[1]}};
    const double largest              = 2. * *std::max_element(grains.radius.begin(), grains.radius.end());
    initial_bed                       = mesh::find_bed_faces(grains, lower[0], upper[0]);
    if (has_fluid)
      {
        const auto context = refinement_context();
        coarse_cell_size = domain.coarse_cell_size() > 0. ? domain.coarse_cell_size() : adaptivity.coarse_size(context);
        triangulation    = domain.make_triangulation(coarse_cell_size);
        adaptivity.check_mesh(*triangulation);
        count_cell_weights();
        adaptivity.balance(*triangulation, cell_weights);
        adaptivity.make_initial_mesh(*triangulation, context);

        const double g = std::hypot(gravity[0], gravity[1]);
        boundary_conditions.initialize(domain.boundary_ids(),
                                       {{"rho", solver.properties.density},
                                        {"eta", solver.properties.viscosity},
                                        {"g", g},
                                        {"H", upper[1] - lower[1]},
                                        {"L", initial_bed.empty() ? 0. : initial_bed.top() - initial_bed.bottom()},
                                        {"d", mesh::mean_diameter(grains)},
                                        {"pi", numbers::PI}});
        const auto periodicity = domain.periodicity();
        space.set_periodic_box({periodicity.lower, periodicity.length});
        space.attach(*triangulation);
        transfer = std::make_unique<mesh::FieldTransfer<dim>>(space.dof_handler(), space.nodal_dof_handler());
        space.reinit(boundary_conditions);
        solver.reinit();
        solver.choose_datum(boundary_conditions);
        coupling.reinit();
        coupling.update_void_fraction(grains);
        find_initial_mesh();
        fluid_view =
          std::make_unique<observers::FluidView>(observers::FluidView{space, solver, boundary_conditions, coupling});
      }
    touched.assign(grains.n(), 0);
    store.initialize(grains, lower, upper, contacts.settings().skin * largest);

    if (grains_move)
      find_initial_contact_forces();

    observing.clear();
    for (observers::Observer *observer : observer_choice.all())
      if (observer->applies(snapshot()))
        observing.push_back(observer);
  }


  void Simulation::Implementation::report_scene(std::ostream &out) const
  {
    const auto line = [&](const std::string &what, const std::string &text) {
      out << "  " << what << std::string(what.size() < 12 ? 12 - what.size() : 1, ' ') << text << '\n';
    };
    const auto number = [](const double x) {
      std::ostringstream text;
      text << x;
      return text.str();
    };
    const double d = mesh::mean_diameter(grains);
    line("grains",
         std::to_string(grains.n()) + " discs, mean diameter " + number(d) + " m, fluid radius " +
           number(grain_setup.radius_factor()) + " of the contact radius");
    if (!initial_bed.empty())
      {
        const double packing = grains::inner_packing_fraction(grains);
        line("bed",
             number(initial_bed.bottom()) + " m to " + number(initial_bed.top()) + " m" +
               (packing > 0. ? ", packing fraction " + number(packing) + " inside" : ""));
      }
    if (has_fluid)
      {
        line("fluid",
             "volume-averaged Navier-Stokes, " + std::to_string(triangulation->n_global_active_cells()) + " cells, " +
               std::to_string(space.n_dofs()) + " unknowns" +
               (solver.discretisation.convection ? "" : "; without convection, as asked"));
        const double tau = solver.properties.viscosity > 0. ? d * d / solver.properties.viscosity : 0.;
        line("coupling",
             std::to_string(coupling.report().n_pieces) + " pieces of grains, void fraction " +
               number(coupling.report().eps_min) + " to " + number(coupling.report().eps_max) + ", rho d^2/eta " +
               number(tau * solver.properties.density) + " s");
        const coupling::HomogeneousBed bed{grains, solver.properties, coupling::inner_void_fraction(grains)};
        const coupling::DragRange      range = coupling.drag_law().range();
        line("drag law",
             coupling.drag_law_name() + " (void fraction " + number(range.eps_min) + " to " + number(range.eps_max) +
               ", Reynolds number to " + number(range.re_max) + ")" +
               (bed.eps < 1.
                  ? "; homogeneous bed of void fraction " + number(bed.eps) + ": permeability " +
                      number(bed.permeability(coupling.drag_law())) + " m^2, fluidised at a superficial velocity of " +
                      number(bed.fluidisation_velocity(coupling.drag_law(), std::hypot(gravity[0], gravity[1]))) +
                      " m/s"
                  : ""));
      }
    else
      line("fluid", "left out (Fluid/Model = none): no mesh, no matrices");
    line("contacts",
         grains_move ? std::to_string(contacts.walls().size()) + " walls; " + contacts.sharing(grains.n())
                     : "left out: all grains are fixed");
    std::string names, idle;
    for (const auto &name : Utilities::split_string_list(observer_choice.name()))
      {
        const bool   works = std::count(observing.begin(), observing.end(), &observer_choice.get(name)) > 0;
        std::string &list  = works ? names : idle;
        list += (list.empty() ? "" : ", ") + name;
      }
    names += idle.empty() ? "" : "; left out, with nothing to measure here: " + idle;
    line("observers", names);
    out << std::flush;
  }


  double Simulation::Implementation::head() const
  {
    const double g = std::hypot(gravity[0], gravity[1]), rho = solver.properties.density;
    if (initial_bed.empty() || g == 0.)
      return std::numeric_limits<double>::quiet_NaN();
    // y + p/(rho g) is the reduced pressure over rho g
    const auto psi = [&](const std::array<double, dim> &u, const double p) {
      return p / (rho * g) + (u[0] * u[0] + u[1] * u[1]) / (2. * g);
    };
    return fluid::line_average<dim>(space, solver.solution(), initial_bed.bottom(), psi) -
           fluid::line_average<dim>(space, solver.solution(), initial_bed.top(), psi);
  }


  observers::Snapshot Simulation::Implementation::snapshot() const
  {
    return {time,
            parameters.time_step,
            n_steps,
            grains,
            initial_bed,
            domain.lower()[0],
            domain.upper()[0],
            gravity,
            grains_move ? &contact_report : nullptr,
            fluid_view.get(),
            grains_move ? &contacts : nullptr,
            folder.path(),
            communicator};
  }


  void Simulation::Implementation::run(const ParameterHandler &prm, const std::string &directory)
  {
    {
      const auto timer = timers.scope("set-up");
      build_scene(directory);
      folder.create(communicator, parameters.restart);
    }
    if (speaks)
      report_scene(std::cout);
    open_output();
    if (parameters.restart)
      read_checkpoint(); // before anything is written: the folder stays as it was if the checkpoint is no good
    if (speaks)
      prm.print_parameters(folder.file("parameters.prm"), ParameterHandler::OutputStyle::ShortPRM);
    if (!parameters.restart)
      {
        observe();
        write_statistics();
        write_pictures();
      }

    const Progress::Style style = parameters.progress == "bar"      ? Progress::Style::bar
                                  : parameters.progress == "lines"  ? Progress::Style::lines
                                  : parameters.progress == "silent" ? Progress::Style::silent
                                                                    : Progress::Style::automatic;
    Progress              progress(communicator, time, parameters.end_time, style, std::cout);
    bool                  stopped = false;
    while (!stopped && time < parameters.end_time - 1e-6 * parameters.time_step)
      {
        step();
        observe();
        if (is_due(time, parameters.time_step, parameters.statistics_interval))
          write_statistics();
        if (parameters.output_interval > 0. && is_due(time, parameters.time_step, parameters.output_interval))
          write_pictures();
        stopped = stop_requested(communicator);
        if (stopped ||
            (parameters.checkpoint_interval > 0. && is_due(time, parameters.time_step, parameters.checkpoint_interval)))
          write_checkpoint();
        progress.update(n_steps, time, parameters.time_step);
      }
    progress.finish();
    conclude(stopped);
  }


  /** One step: the order of the paper's section 2.3. */
  void Simulation::Implementation::step()
  {
    const double dt = parameters.time_step;
    if (has_fluid)
      {
        if (adaptivity.due(n_steps))
          adapt_mesh();
        const auto timer = timers.scope("fluid");
        boundary_conditions.set_time(time + dt);
        solver.accept();
        coupling.step(boundary_conditions, grains, touched, dt, !grains_move, loads);
      }
    else
      load_by_gravity();

    if (grains_move)
      {
        if (has_fluid)
          contact_report = contact_iteration.advance(grains, loads, dt, gravity);
        else
          {
            const auto timer = timers.scope("contacts");
            contact_report   = contacts.advance(grains, loads, dt, gravity);
          }
        const auto timer = timers.scope("contacts");
        touched          = contacts.touched();
        store.scatter(grains);
        grains = store.gather();
      }
    time = ++n_steps * dt;

    counts["contact sweeps"] += contact_report.n_sweeps;
    counts["contact steps at rest"] += contact_report.at_rest;
    counts["contact sub-steps"] += contact_report.n_substeps;
    counts["contact sub-steps halved"] += contact_report.n_halvings;
    counts["contact sub-steps not converged"] += contact_report.n_unconverged;
    counts["linear iterations"] += coupling.report().n_iterations;
    counts["repetitions of fluid and contacts"] += contact_iteration.n_repetitions();
    counts["steps that ended above the tolerance of repetitions"] += !contact_iteration.agrees();
    counts["fluid steps like the last"] += coupling.report().steady;
    counts["linear solves above the tolerance"] += coupling.report().n_loose;
  }


  void Simulation::Implementation::load_by_gravity()
  {
    loads.reset(grains.n());
    for (std::size_t i = 0; i < grains.n(); ++i)
      {
        loads.fx[i] = grains.mass[i] * gravity[0];
        loads.fy[i] = grains.mass[i] * gravity[1];
      }
  }


  /**
   * The first prediction needs the contact forces at rest: without them the bed would "fall" in it. They come from a
   * step of the contacts under the grains' reduced weight, whose motion is thrown away; or from some steps, if nothing
   * moves in them: then the bed is known to be at rest when the run starts.
   */
  void Simulation::Implementation::find_initial_contact_forces()
  {
    load_by_gravity();
    if (has_fluid)
      for (std::size_t i = 0; i < grains.n(); ++i)
        {
          const double displaced =
            solver.properties.density * numbers::PI * grains.fluid_radius[i] * grains.fluid_radius[i];
          loads.fx[i] -= displaced * gravity[0];
          loads.fy[i] -= displaced * gravity[1];
        }
    grains::GrainArrays trial         = grains;
    unsigned int        n_steps_tried = 0;
    do
      contact_report = contacts.advance(trial, loads, parameters.time_step, gravity);
    while (contact_report.n_quiet == ++n_steps_tried);
    touched    = contacts.touched();
    grains.fcx = trial.fcx;
    grains.fcy = trial.fcy;
  }


  mesh::RefinementContext Simulation::Implementation::refinement_context() const
  {
    const auto length  = domain.periodicity().length;
    auto       context = mesh::make_refinement_context(
      grains, {{{domain.lower()[0], domain.lower()[1]}}, {{domain.upper()[0], domain.upper()[1]}}});
    context.periodic = {{length[0] > 0., length[1] > 0.}};
    context.time     = time;
    context.gravity  = std::hypot(gravity[0], gravity[1]);
    return context;
  }


  void Simulation::Implementation::count_cell_weights()
  {
    cell_weights.count(grains.x, grains.y, coupling.reach(mesh::mean_diameter(grains)));
  }


  /** Criteria that look at the fluid see more on a finer mesh: they are asked until the mesh stays. */
  void Simulation::Implementation::find_initial_mesh()
  {
    constexpr unsigned int max_rounds = 10;
    for (unsigned int round = 0; adaptivity.needs_fluid() && round < max_rounds; ++round)
      {
        if (!adapt_mesh())
          break;
        coupling.update_void_fraction(grains);
      }
  }


  bool Simulation::Implementation::adapt_mesh()
  {
    const auto             timer = timers.scope("mesh adaptation");
    fluid::BlockVector     field, before;
    const mesh::FluidState fluid_state{space, solver.solution(), coupling.void_fraction()};
    auto                   context = refinement_context();
    context.fluid                  = &fluid_state;
    count_cell_weights();
    const auto report = adaptivity.adapt(
      *triangulation,
      context,
      [&] {
        transfer->prepare({&solver.solution(), &solver.old()});
      },
      [&] {
        space.reinit(boundary_conditions);
        field = before = space.make_field();
        transfer->interpolate({&field, &before}, space.hanging_constraints(), {}, space.nodal_constraints());
        solver.reinit();
        solver.set_solution(field);
        solver.old() = before;
        coupling.reinit();
        counts["mesh adaptations"] += 1;
      });
    if (report.changed && n_steps > 0)
      {
        solver.set_solution(field);
        boundary_conditions.set_time(time);
        counts["rebalanced flows"] += coupling.rebalance(boundary_conditions, grains, parameters.time_step, before);
      }
    return report.changed;
  }


  void Simulation::Implementation::observe()
  {
    const auto timer = timers.scope("observers");
    if (has_fluid)
      fluid_view->head = head();
    for (auto *observer : observing)
      observer->observe(snapshot());
  }


  void Simulation::Implementation::open_output()
  {
    statistics =
      std::make_unique<observers::Statistics>(folder.file("statistics.csv"), communicator, parameters.precision);
    summary         = std::make_unique<observers::Summary>(folder.file("summary.json"), communicator);
    const bool hdf5 = parameters.format == "hdf5";
    grain_pictures  = std::make_unique<observers::FieldSeries>(folder.path(), "grains", hdf5, communicator);
    fluid_pictures  = std::make_unique<observers::FieldSeries>(folder.path(), "fluid", hdf5, communicator);
    statistics->add_column("time_s");
    for (auto *observer : observing)
      observer->add_columns(snapshot(), *statistics);
  }


  void Simulation::Implementation::write_statistics()
  {
    const auto timer = timers.scope("observers");
    statistics->set("time_s", time);
    for (auto *observer : observing)
      observer->write(snapshot(), *statistics);
    statistics->write_row();
  }


  void Simulation::Implementation::write_pictures()
  {
    if (parameters.output_interval == 0.)
      return;
    const auto timer = timers.scope("pictures");
    store.output([&](auto &data) { grain_pictures->write<0>(data, ReferenceCells::Vertex, time); });
    if (has_fluid)
      observers::write_fluid(*fluid_pictures,
                             space,
                             solver.solution(),
                             coupling.void_fraction(),
                             solver.properties.density * solver.gravity,
                             solver.datum(),
                             time);
  }


  void Simulation::Implementation::conclude(const bool interrupted)
  {
    for (auto *observer : observing)
      observer->conclude(*summary);
    summary->set("run/time_s", time);
    summary->set("run/steps", n_steps);
    summary->set("run/interrupted", interrupted);
    summary->set("run/ranks", Utilities::MPI::n_mpi_processes(communicator));
    summary->set("domain/lower_m", std::vector<double>{domain.lower()[0], domain.lower()[1]});
    summary->set("domain/upper_m", std::vector<double>{domain.upper()[0], domain.upper()[1]});
    summary->set("scene/grains", grains.n());
    if (has_fluid)
      {
        summary->set("scene/cells", static_cast<unsigned long>(triangulation->n_global_active_cells()));
        summary->set("scene/unknowns", static_cast<unsigned long>(space.n_dofs()));
        summary->set("scene/pieces", coupling.report().n_pieces);
      }
    for (const auto &[name, count] : counts)
      summary->set("counts/" + name, count);
    timers.add(solver.timers);
    const auto phases = timers.slowest(communicator);
    for (const auto &[name, phase] : phases)
      {
        summary->set("timing/" + name + "/wall_s", phase.wall);
        summary->set("timing/" + name + "/cpu_s", phase.cpu);
      }
    if (counts["contact sub-steps not converged"] > 0)
      summary->warn(std::to_string(static_cast<long>(counts["contact sub-steps not converged"])) +
                    " contact sub-steps were accepted above the tolerance; see Contacts in the parameters.");
    if (counts["linear solves above the tolerance"] > 0)
      summary->warn(std::to_string(static_cast<long>(counts["linear solves above the tolerance"])) +
                    " linear solves of the fluid stopped above the tolerance, at a relative residual below 1e-5.");
    if (has_fluid)
      warn_of_drag_range();
    summary->write();
    if (speaks)
      {
        double total = 0.;
        for (const auto &[name, phase] : phases)
          total += name.find(": ") == std::string::npos ? phase.wall : 0.;
        print_timers(std::cout, phases, total);
      }
  }


  void Simulation::Implementation::warn_of_drag_range()
  {
    const std::vector<grains::GrainId> ids = coupling.outside_drag_range(grains);
    if (ids.empty())
      return;
    const coupling::DragRange range = coupling.drag_law().range();
    std::ostringstream        text;
    text << ids.size() << " of " << grains.n() << " grains were at some time outside the range of the drag law '"
         << coupling.drag_law_name() << "' (void fraction " << range.eps_min << " to " << range.eps_max
         << ", Reynolds number " << range.re_min << " to " << range.re_max << "): ids ";
    const std::size_t n_shown = std::min<std::size_t>(ids.size(), 20);
    for (std::size_t i = 0; i < n_shown; ++i)
      text << (i ? ", " : "") << ids[i];
    text << (n_shown < ids.size() ? ", ..." : "") << '.';
    summary->warn(text.str());
    if (speaks)
      std::cout << "Warning: " << text.str() << std::endl;
  }


  void Simulation::Implementation::write_checkpoint()
  {
    const auto timer = timers.scope("checkpoints");
    // a new folder takes the place of the old one only when it is complete
    const std::string final = checkpoint_folder(), folder_new = final + ".new";
    if (speaks)
      {
        std::filesystem::remove_all(folder_new);
        std::filesystem::create_directories(folder_new);
      }
    MPI_Barrier(communicator);
    grains::save_grains(communicator, folder_new + "/grains", grains, contacts.archive());
    // the run that goes on and the one that restarts shall both begin with a new contact search ...
    contacts.forget_search();
    if (has_fluid)
      {
        mesh::FluidCheckpoint<dim>(folder_new)
          .save(space.dof_handler(), {&solver.solution(), &solver.old()}, space.nodal_dof_handler(), {});
        // ... with a fresh preconditioner, and with all grains cut anew
        solver.linear_solver.clear();
        coupling.forget_positions();
      }
    std::string text;
    if (speaks)
      {
        nlohmann::ordered_json state;
        state["time"]           = time;
        state["steps"]          = n_steps;
        state["grain pictures"] = grain_pictures->state();
        state["fluid pictures"] = fluid_pictures->state();
        state["datum"]          = solver.datum();
        state["counts"]         = counts;
        for (const auto &name : Utilities::split_string_list(observer_choice.name()))
          observer_choice.get(name).save(state["observers"][name]);
        text = state.dump(1);
      }
    write_checked_file(communicator, folder_new + "/state", "state", text);
    if (speaks)
      {
        // whenever the machine stops, there is a whole checkpoint: the new one or the one before
        const std::string before = final + ".before";
        std::filesystem::remove_all(before);
        if (std::filesystem::exists(final))
          std::filesystem::rename(final, before);
        std::filesystem::rename(folder_new, final);
        std::filesystem::remove_all(before);
      }
    MPI_Barrier(communicator);
  }


  void Simulation::Implementation::read_checkpoint()
  {
    const std::string newest = checkpoint_folder(),
                      from   = std::filesystem::exists(newest) ? newest : newest + ".before";
    check_user(std::filesystem::is_directory(from),
               "Output/Restart: there is no checkpoint in '" + folder.path() + "'.");
    const std::string      text = read_checked_file(communicator, from + "/state", "state");
    nlohmann::ordered_json state;
    try
      {
        state   = nlohmann::ordered_json::parse(text);
        time    = state.at("time");
        n_steps = state.at("steps");
        grain_pictures->resume(state.at("grain pictures"));
        fluid_pictures->resume(state.at("fluid pictures"));
        solver.set_datum(state.at("datum"));
        counts = state.at("counts").get<decltype(counts)>();
        for (const auto &name : Utilities::split_string_list(observer_choice.name()))
          if (!state.at("observers").at(name).is_null())
            observer_choice.get(name).load(state.at("observers").at(name));
      }
    catch (const nlohmann::json::exception &)
      {
        throw UserError("Output/Restart: '" + from +
                        "/state' is not as this program writes it: was it made by another version?");
      }
    grains::ContactArchive archive;
    const std::size_t      n = grains.n();
    grains::load_grains(communicator, from + "/grains", grains, archive);
    check_user(grains.n() == n,
               "Output/Restart: the checkpoint has " + std::to_string(grains.n()) + " grains, the scene " +
                 std::to_string(n) + ".");
    contacts.set_archive(archive);
    for (std::size_t i = 0; i < n; ++i)
      touched[i] = grains.fcx[i] != 0. || grains.fcy[i] != 0.;
    store.scatter(grains);
    if (has_fluid)
      {
        mesh::FluidCheckpoint<dim> checkpoint(from);
        auto                       mesh = domain.make_triangulation(coarse_cell_size);
        checkpoint.load_mesh(*mesh);
        adaptivity.balance(*mesh, cell_weights);
        space.attach(*mesh);
        triangulation = std::move(mesh);
        transfer      = std::make_unique<mesh::FieldTransfer<dim>>(space.dof_handler(), space.nodal_dof_handler());
        space.reinit(boundary_conditions);
        solver.reinit();
        coupling.reinit();
        fluid::BlockVector field = space.make_field(), before = field;
        checkpoint.load_fields(space.dof_handler(), {&field, &before}, space.nodal_dof_handler(), {});
        solver.set_solution(field);
        solver.old() = before;
        solver.old().update_ghost_values();
      }
    statistics->resume(time);
  }


  Simulation::Simulation(MPI_Comm communicator)
    : implementation(std::make_unique<Implementation>(communicator))
  {}


  Simulation::~Simulation() = default;


  std::vector<std::pair<std::string, std::string>> Simulation::paper_method()
  {
    return {{"Coupling/Filter radius", "grain"},
            {"Coupling/Overlap rule", "centroid"},
            {"Coupling/Drag law", "paper"},
            {"Coupling/Time scheme", "semi-implicit per piece"},
            {"Fluid/Lumped drag", "false"}};
  }


  void Simulation::add_parameters(ParameterHandler &prm)
  {
    implementation->add_parameters(prm);
  }


  void Simulation::check(const std::string &parameter_directory)
  {
    implementation->build_scene(parameter_directory);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      implementation->report_scene(std::cout);
  }


  void Simulation::run(const ParameterHandler &prm, const std::string &parameter_directory)
  {
    implementation->run(prm, parameter_directory);
  }
} // namespace alluvium
