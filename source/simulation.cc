#include <alluvium/run/check_boundaries.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/check_void_fraction.h>
#include <alluvium/run/check_walls.h>
#include <alluvium/run/checkpoint.h>
#include <alluvium/run/leavers.h>
#include <alluvium/run/mesh_changes.h>
#include <alluvium/run/model.h>
#include <alluvium/run/model_choice.h>
#include <alluvium/run/output.h>
#include <alluvium/run/poles.h>
#include <alluvium/run/run_guard.h>
#include <alluvium/run/scene_report.h>
#include <alluvium/run/set_up.h>
#include <alluvium/run/slow_run.h>
#include <alluvium/run/time_step_control.h>
#include <alluvium/scene/declared_parameters.h>
#include <alluvium/simulation.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/pace.h>
#include <alluvium/utilities/progress.h>
#include <alluvium/utilities/signals.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iostream>
#include <sstream>

namespace alluvium
{
  using namespace dealii;

  class Simulation::Implementation
  {
  public:
    explicit Implementation(MPI_Comm communicator)
      : model(communicator)
      , output(model)
      , time_step(model)
      , guard(model, output)
    {}

    void   add_parameters(ParameterHandler &prm);
    double report_scene() const;
    void   check(const ParameterHandler &prm, const std::string &directory);
    void   run(const ParameterHandler &prm, const std::string &directory);

    run::Model  model;
    run::Output output;
    double      end_time = 1.; // [s]

  private:
    void prepare(const ParameterHandler &prm, const std::string &directory, bool writes);
    void report_restart() const;
    void check_time_step();
    bool has_ended() const { return model.time >= end_time - 1e-6 * model.time_step; }
    int  advance();
    void step();
    bool try_step(bool mesh_has_changed);
    void watch_model();
    void summarise_model();
    void count_step();

    run::TimeStepControl time_step;
    run::ModelChoice     model_choice;

    run::RunGuard guard;
    bool          restart           = false;
    std::string   progress          = "automatic";
    double        expected_duration = 0.; // of the run [s on the wall]

    std::unique_ptr<run::Checkpoint> checkpoint; // that a restart begins from
    std::vector<std::string>         changes;    // of parameters, since then
  };


  void Simulation::Implementation::add_parameters(ParameterHandler &prm)
  {
    model.add_parameters(prm);
    model_choice.add_parameters(prm);
    time_step.add_parameters(prm);
    output.add_parameters(prm);
    guard.add_parameters(prm);
    prm.enter_subsection("Time");
    prm.add_parameter("End time",
                      end_time,
                      "When the run ends [s]. Where it is no multiple of a fixed time step, the last step is shorter.",
                      Patterns::Double(0.));
    prm.leave_subsection();
    prm.enter_subsection("Output");
    prm.add_parameter("Restart", restart, "Continue from the checkpoint in the output folder.");
    prm.add_parameter("Progress", progress, "How to show progress.", Patterns::Selection("automatic|bar|lines|silent"));
    prm.leave_subsection();
  }


  double Simulation::Implementation::report_scene() const
  {
    return run::report_scene(model, output, time_step, model_choice, end_time, std::cout);
  }


  /**
   * All before the first step, and before anything is written: the folder stays as it was if scene or checkpoint are no
   * good. With @p writes false it is only looked at.
   */
  void Simulation::Implementation::prepare(const ParameterHandler &prm, const std::string &directory, const bool writes)
  {
    const scene::DeclaredParameters declared(prm);
    for (const auto &p : declared.parameters())
      model.parameters.emplace_back(scene::to_string(p.path), p.value);
    const auto timer = model.timers.scope("set-up");
    model.parse_parameters();
    model_choice.parse_parameters();
    time_step.parse_parameters(end_time);
    output.parse_parameters();
    const std::string remark = output.check_folder(restart, !writes);
    if (!remark.empty())
      model.warnings.print("a run would be refused: " + remark);
    if (restart)
      {
        if (writes)
          output.make_folder(true);
        checkpoint = std::make_unique<run::Checkpoint>(model.communicator, output.folder().file("checkpoint"));
        changes    = checkpoint->compare_parameters(model);
      }
    run::set_up(model, directory, checkpoint.get(), end_time, model_choice);
    // a run that was killed between its last checkpoint and its summary has the summary left to do
    check_user(!restart || !has_ended() ||
                 (model.time <= end_time + 1e-6 * model.time_step && !output.holds_finished_run()),
               "Output/Restart: the checkpoint is of t = " + in_digits(model.time) +
                 " s, and Time/End time = " + in_digits(end_time) + " s has passed: nothing is left to do.");
    run::check_boundaries(model, end_time);
    run::check_void_fraction(model);
    run::check_walls(model, end_time);
    run::check_poles(model, end_time);
    std::vector<double> intervals = output.intervals();
    intervals.push_back(guard.interval_of_checkpoints());
    time_step.prepare(end_time, intervals);
    check_time_step();
    if (!restart || !model_choice.load(checkpoint->saved_state(), model))
      model_choice.choose(model, {end_time, output.intervals()[0], time_step.automatic()});
    summarise_model();
    output.choose_observers();
    if (writes && !restart)
      output.make_folder(false);
    else if (!restart)
      output.check_folder(false, true); // now that it is known what the deposit reads
    output.open();
  }


  /** Warn if it is beyond the time scheme's limit. A chosen one obeys that, unless it is zero. */
  void Simulation::Implementation::check_time_step()
  {
    if (!time_step.automatic() || run::stable_step(model) == 0.)
      run::check_time_step(model);
    else if (model.n_steps == 0)
      run::check_number_of_steps(model, end_time);
  }


  void Simulation::Implementation::report_restart() const
  {
    if (!restart || !model.is_root)
      return;
    std::cout << checkpoint->description(model) << std::endl;
    for (const auto &change : changes)
      std::cout << "  changed: " << change << std::endl;
  }


  void Simulation::Implementation::check(const ParameterHandler &prm, const std::string &directory)
  {
    model.grain_setup.write_nothing();
    prepare(prm, directory, false);
    report_scene();
    report_restart();
  }


  void Simulation::Implementation::run(const ParameterHandler &prm, const std::string &directory)
  {
    prepare(prm, directory, true);
    install_stop_signals();
    expected_duration = report_scene();
    report_restart();
    if (restart)
      {
        checkpoint->resume(output);
        guard.resume(checkpoint->saved_state());
        time_step.load(checkpoint->saved_state());
      }
    checkpoint.reset();
    guard.also_save([this](nlohmann::ordered_json &state) {
      time_step.save(state);
      model_choice.save(model, state);
    });
    guard.begin(restart);
    try
      {
        std::ostringstream used;
        prm.print_parameters(used, ParameterHandler::OutputStyle::ShortPRM);
        write_atomically(model.communicator, output.folder().file("parameters.prm"), used.str());
        if (!restart)
          output.write_beginning();
        guard.conclude(advance());
      }
    catch (...)
      {
        guard.fail(describe_failure(std::current_exception()));
        throw;
      }
  }


  /** Step until the end, or a signal, which is returned. */
  int Simulation::Implementation::advance()
  {
    const Progress::Style style = progress == "bar"      ? Progress::Style::bar
                                  : progress == "lines"  ? Progress::Style::lines
                                  : progress == "silent" ? Progress::Style::silent
                                                         : Progress::Style::automatic;
    Progress              shown(model.communicator, model.time, end_time, style, std::cout);
    Pace                  pace(model.time, end_time, expected_duration);
    int                   signal = 0;
    guard.start();
    while (signal == 0 && !has_ended())
      {
        try
          {
            step();
          }
        catch (const Divergence &error)
          {
            throw guard.with_place(error);
          }
        count_step();
        guard.judge();
        constexpr unsigned int check_interval = 20; // grains settle, and the limit falls
        if (model.n_steps % check_interval == 0)
          check_time_step();
        output.update();
        watch_model();
        signal = stop_requested(model.communicator);
        guard.keep();
        run::watch_pace(model, pace);
        shown.update(model.n_steps, model.time, model.time_step, guard.state_in_words());
      }
    shown.finish();
    return has_ended() ? 0 : signal; // in the last step it interrupts nothing
  }


  /** One step: the order of the paper's section 2.3. */
  void Simulation::Implementation::step()
  {
    run::Model &m                = model;
    bool        mesh_has_changed = false;
    if (run::remove_leavers(m))
      guard.after_removal();
    const bool has_sizes = m.grains.n() > 0 || m.grain_setup.unit_length() > 0.; // cells are measured in grains
    if (m.has_fluid && model_choice.adapts() && m.adaptivity.due(m.n_steps) && has_sizes)
      {
        guard.before_mesh_change();
        mesh_has_changed = run::adapt_mesh(m);
        guard.after_mesh_change();
      }
    time_step.choose();
    while (!try_step(mesh_has_changed))
      ;
    if (m.grains_move)
      {
        const auto timer = m.timers.scope("contacts");
        m.touched        = m.contacts.touched();
        m.store.check_positions(m.time_step);
        run::count_leavers(m);
      }
    m.time = m.clock.at(++m.n_steps);
  }


  /** Solve fluid and contacts for a step; false if it is too long, and everything as before it. */
  bool Simulation::Implementation::try_step(const bool mesh_has_changed)
  {
    run::Model  &m  = model;
    const double dt = m.time_step;
    try
      {
        time_step.begin(mesh_has_changed);
        if (m.has_fluid)
          {
            m.boundary_conditions.set_time(time_step.end_of_step());
            if (!m.coupled_step.step(m.boundary_conditions,
                                     {m.time, dt, m.gravity, !m.grains_move},
                                     m.touched,
                                     m.grains,
                                     m.loads,
                                     m.contact_report,
                                     [this] { return time_step.accepts_fluid(); }))
              return false;
          }
        else
          {
            run::load_by_gravity(m);
            if (m.grains_move)
              {
                const auto timer = m.timers.scope("contacts");
                m.contacts.set_time(m.time);
                m.contact_report = m.contacts.advance(m.grains, m.loads, dt, m.gravity);
              }
          }
        if (!time_step.accepts_step())
          return false;
        guard.judge_contacts(); // before grains are put where they cannot be
        return true;
      }
    catch (const Divergence &)
      {
        if (!time_step.rescue())
          throw;
      }
    catch (const ExceptionBase &) // of the linear solver
      {
        if (!time_step.rescue())
          {
            run::blame_void_fraction(m);
            throw;
          }
      }
    return false;
  }


  /** Switch on what the last step shows to be wanted. */
  void Simulation::Implementation::watch_model()
  {
    const auto switched = model_choice.watch(model);
    if (switched.empty())
      return;
    for (const auto &of_term : switched)
      if (model.is_root)
        std::cout << of_term.text << std::endl;
    summarise_model();
    guard.after_model_change();
  }


  void Simulation::Implementation::summarise_model()
  {
    for (const auto &row : model_choice.rows())
      {
        const std::string path = "model/" + run::name_of(row.term.term) + "/";
        output.add_to_summary(path + "on", row.term.on ? "yes" : "no");
        output.add_to_summary(path + "because", row.term.because);
        output.add_to_summary(path + "estimate", row.term.estimate);
        if (!std::isnan(row.since))
          output.add_to_summary(path + "switched_on_s", row.since);
      }
  }


  void Simulation::Implementation::count_step()
  {
    auto &counts = model.counts;
    counts["contact sweeps"] += model.contact_report.n_sweeps;
    counts["contact steps at rest"] += model.contact_report.at_rest;
    counts["contact solves' corrections of moments"] += model.contact_report.n_corrections;
    counts["contact sub-steps"] += model.contact_report.n_substeps;
    counts["contact sub-steps halved"] += model.contact_report.n_halvings;
    counts["contact sub-steps that stalled"] += model.contact_report.n_stalled;
    counts["contact sub-steps not converged"] += model.contact_report.n_unconverged;
    counts["linear iterations"] += model.coupling.report().n_iterations;
    counts["repetitions of fluid and contacts"] += model.coupled_step.iteration().n_iterations();
    counts["steps that ended above the tolerance of repetitions"] += !model.coupled_step.iteration().agrees();
    counts["fluid steps like the last"] += model.coupling.report().steady;
    counts["linear solves above the tolerance"] += model.coupling.report().n_loose;
    counts["linear solves by the direct solver"] += model.coupling.report().n_direct;
    counts["steps with cells too uneven to be cut by lines"] += model.coupling.overlap().is_non_tensor();

    const auto warn = [&](const char *text, const double count) {
      if (count > 0.)
        model.warnings.add(text, model.time, count);
    };
    warn("contact sub-steps were accepted above the tolerance; see Contacts in the parameters",
         model.contact_report.n_unconverged);
    warn("linear solves of the fluid stopped above the tolerance, at a relative residual below 1e-5",
         model.coupling.report().n_loose);
    warn("linear solves of the fluid took the direct solver, since GMRES had failed: look whether the flow is resolved "
         "in time and space",
         model.coupling.report().n_direct);
    warn("steps had cells whose sides lie on too many different lines: grains were cut cell by cell, which takes two "
         "to four times as long",
         model.coupling.overlap().is_non_tensor());
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


  void Simulation::describe_accuracy(const std::vector<std::string> &lines)
  {
    implementation->model.accuracy = lines;
  }


  void Simulation::check(const ParameterHandler &prm, const std::string &parameter_directory)
  {
    implementation->check(prm, parameter_directory);
  }


  void Simulation::run(const ParameterHandler &prm, const std::string &parameter_directory)
  {
    implementation->run(prm, parameter_directory);
  }
} // namespace alluvium
