#include <alluvium/run/checkpoint.h>
#include <alluvium/run/model.h>
#include <alluvium/run/run_guard.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/log.h>
#include <alluvium/utilities/signals.h>
#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/version.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/tria.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <tuple>

namespace alluvium::run
{
  using namespace dealii;

  RunGuard::~RunGuard()
  {
    if (of_failures != MPI_COMM_NULL)
      MPI_Comm_free(&of_failures);
  }


  void RunGuard::add_parameters(ParameterHandler &prm)
  {
    monitor.add_parameters(prm);
    prm.enter_subsection("Output");
    prm.add_parameter("Interval of checkpoints",
                      interval,
                      "Time between two checkpoints [s]; 0: only when the run ends or is interrupted.",
                      Patterns::Double(0.));
    prm.leave_subsection();
  }


  void RunGuard::begin(const bool is_restart)
  {
    Log::open(output.folder().file("log.txt"), headline(is_restart), is_restart);
    // what is never answered, if ranks are lost, must not meet other messages
    MPI_Comm_dup(model.communicator, &of_failures);
    if (is_restart)
      checkpoint_step = model.n_steps;
  }


  void RunGuard::resume(const nlohmann::ordered_json &state)
  {
    monitor.load(state);
  }


  void RunGuard::start()
  {
    meter.begin(model);
    fastest = fastest_grain(model);
    keep_good_state();
    write_provisional_summary();
  }


  std::string RunGuard::headline(const bool is_restart) const
  {
    const std::time_t  now = std::time(nullptr);
    std::ostringstream text;
    text << "--- alluvium " << version() << ", " << std::put_time(std::localtime(&now), "%Y-%m-%d %H:%M:%S") << ", "
         << Utilities::MPI::n_mpi_processes(model.communicator) << " rank(s), ";
    if (is_restart)
      text << "continued from t = " << model.time << " s";
    else
      text << "a new run";
    return text.str();
  }


  void RunGuard::after_mesh_change()
  {
    meter.forget_mesh();
    if (monitor.is_calm())
      keep_good_state();
  }


  void RunGuard::after_removal()
  {
    meter.begin(model);
  }


  void RunGuard::judge()
  {
    const auto timer = model.timers.scope("divergence monitor");
    measures         = meter.measure(model);
    fastest          = fastest_grain(model);
    const Sign sign  = monitor.judge(model, measures);
    if (!sign.what.empty())
      raise(sign, model.n_steps, model.time);
    else if (const std::string doubt = monitor.doubt_overlap(model); !doubt.empty())
      model.warnings.add(doubt, model.time);
  }


  void RunGuard::judge_contacts()
  {
    const Sign sign = monitor.judge_contacts(model);
    if (!sign.what.empty())
      raise(sign, model.n_steps + 1, model.time + model.time_step);
  }


  /** End the run, or warn. */
  void RunGuard::raise(const Sign &sign, const unsigned int step, const double time)
  {
    if (!monitor.stops() && std::isfinite(sign.value))
      {
        // of one text, so that it is said once and counted; after a restart, too
        const std::string kind = "A step cannot be believed, which ends a run unless Divergence/Stop = false. First: ";
        std::string       text = kind + in_words(sign, step, time);
        for (const auto &warning : model.warnings.all())
          if (warning.text.compare(0, kind.size(), kind) == 0)
            text = warning.text;
        model.warnings.add(text, time);
        return;
      }
    output.add_to_summary("divergence/sign", sign.what);
    output.add_to_summary("divergence/value", sign.value);
    output.add_to_summary("divergence/bound", sign.bound);
    output.add_to_summary("divergence/unit", sign.unit);
    output.add_to_summary("divergence/x_m", sign.point[0]);
    output.add_to_summary("divergence/y_m", sign.point[1]);
    output.add_to_summary("divergence/near", sign.near);
    has_judged = true;
    throw Divergence(in_words(sign, step, time));
  }


  Divergence RunGuard::with_place(const Divergence &error) const
  {
    if (has_judged)
      return error;
    std::ostringstream text;
    text << "The run has diverged in step " << model.n_steps + 1 << ", from t = " << model.time
         << " s: " << error.what();
    if (!fastest.name.empty())
      text << " Before it, " << fastest.name << " was the fastest: " << measures.grain_velocity << " m/s, at ("
           << fastest.point[0] << ", " << fastest.point[1] << ") m.";
    text << " Try a smaller Time/Time step.";
    return Divergence(text.str());
  }


  void RunGuard::keep()
  {
    is_due = is_due || (interval > 0. && run::is_due(model.time, model.time_step, interval));
    if (monitor.is_calm()) // a step in doubt shall not take the place of one that was good
      {
        if (is_due)
          write_checkpoint();
        constexpr unsigned int keep_interval = 10;
        if (model.n_steps % keep_interval == 0)
          keep_good_state();
      }
    write_provisional_summary();
  }


  void RunGuard::keep_good_state()
  {
    good.keep(model, [&](nlohmann::ordered_json &state) {
      output.save(state);
      save_more(state);
    });
  }


  void RunGuard::write_checkpoint()
  {
    check_user(disk_has_room(),
               "cannot write '" + output.folder().file("checkpoint") + "': there is hardly any room left on the disk.");
    Checkpoint::write(output.folder().file("checkpoint"), model, [&](nlohmann::ordered_json &state) {
      output.save(state);
      monitor.save(state);
      save_more(state);
    });
    checkpoint_step = model.n_steps;
    is_due          = false;
  }


  /** Leaves the model as it was then. */
  void RunGuard::write_good_state()
  {
    const auto         reached = std::make_tuple(model.time, model.n_steps, model.counts);
    std::ostringstream text;
    if (good.is_there() && good.n_steps() > checkpoint_step)
      {
        good.write(output.folder().file("checkpoint"), model);
        text << "step " << good.n_steps() << ", t = " << good.time() << " s, the last that was kept in memory as good";
      }
    else if (checkpoint_step >= 0)
      text << "step " << checkpoint_step << ", the last that was written";
    else
      text << "none: no step was known to be good";
    std::tie(model.time, model.n_steps, model.counts) = reached;
    output.add_to_summary("run/checkpoint", text.str());
    if (model.is_root)
      std::cout << "Checkpoint: " << text.str() << "." << std::endl;
  }


  std::string RunGuard::state_in_words() const
  {
    char text[150];
    if (model.has_fluid)
      std::snprintf(text,
                    sizeof(text),
                    "Courant %.2g  u %.3g m/s  v %.3g m/s  %u iterations",
                    measures.courant,
                    measures.fluid_velocity,
                    measures.grain_velocity,
                    measures.n_iterations);
    else
      std::snprintf(text, sizeof(text), "v %.3g m/s", measures.grain_velocity);
    return text;
  }


  void RunGuard::conclude(const int signal)
  {
    output.add_to_summary("audit/largest_unexplained_energy_over_bound", monitor.largest_share());
    if (checkpoint_step != long(model.n_steps))
      {
        if (monitor.is_calm())
          write_checkpoint();
        else
          {
            std::ostringstream text;
            text << "the last steps are in doubt, so that the checkpoint is an earlier one: energy that nothing has "
                    "supplied has reached "
                 << monitor.largest_share() << " of what ends a run. Try a smaller Time/Time step.";
            model.warnings.add(text.str(), model.time);
            write_good_state();
          }
      }
    if (signal != 0)
      output.conclude({"interrupted", "stopped by " + signal_name(signal), 0});
    else
      output.conclude({"finished", "the end time is reached", 0});
  }


  /** What is left if the run is killed without a word, or by a rank that fails alone; not older than half a minute. */
  void RunGuard::write_provisional_summary()
  {
    using Clock    = std::chrono::steady_clock;
    const auto now = Clock::now();
    if (last_summary != Clock::time_point() && now - last_summary < std::chrono::seconds(30))
      return;
    last_summary = now;
    try
      {
        output.write_summary_alone({"failed", "the run has not come to its end: it goes on, or was killed", -1});
      }
    catch (const UserError &error) // one rank's alone, and not the last summary
      {
        model.warnings.print(error.what());
      }
  }


  bool RunGuard::disk_has_room() const
  {
    std::error_code error;
    const auto      space    = std::filesystem::space(output.folder().path(), error);
    const double    needed   = 1e6 + 200. * model.grains.n() + (model.has_fluid ? 200. * model.space.n_dofs() : 0.);
    int             has_room = error || space.available > needed;
    MPI_Bcast(&has_room, 1, MPI_INT, 0, model.communicator);
    return has_room != 0;
  }


  void RunGuard::fail(const Failure &failure)
  {
    const Ending ending{"failed", failure.message, failure.exit_code};
    try
      {
        if (!failed_together(of_failures, failure.message))
          {
            if (model.is_root)
              output.write_summary_alone(ending);
            else
              output::Summary::amend(output.folder().file("summary.json"),
                                     {{"ended", ending.how}, {"reason", ending.reason}},
                                     ending.exit_code);
            return;
          }
        output.write_summary_alone(ending); // the rest may not come to its end
        if (disk_has_room())
          write_good_state();
        output.conclude(ending);
      }
    catch (const std::exception &error)
      {
        model.warnings.print(std::string("not all could be written at the end: ") + error.what());
      }
  }
} // namespace alluvium::run
