#include <alluvium/grains/bed_faces.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/kinks.h>
#include <alluvium/run/model.h>
#include <alluvium/run/scene_numbers.h>
#include <alluvium/run/time_step_control.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    constexpr double infinity  = std::numeric_limits<double>::infinity();
    constexpr double same_time = 1e-9; // in steps

    /** Fourth mean of the lengths of vectors of the grains that are not fixed: near the largest, if many are like it.
     */
    template <typename Vector>
    double fourth_mean(const grains::GrainArrays &grains, const Vector &vector)
    {
      double sum = 0., n = 0.;
      for (std::size_t i = 0; i < grains.n(); ++i)
        if (!std::isinf(grains.mass[i]))
          {
            const std::array<double, 2> v  = vector(i);
            const double                vv = v[0] * v[0] + v[1] * v[1];
            sum += vv * vv;
            n += 1.;
          }
      return n > 0. ? std::sqrt(std::sqrt(sum / n)) : 0.;
    }
  } // namespace


  void TimeStepControl::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Time");
    prm.add_parameter(
      "Time step",
      text,
      "Step of the fluid and of the coupling [s]; contacts take sub-steps. `auto`: each step is as long "
      "as `Automatic time step` lets it be.",
      Patterns::Anything());
    prm.enter_subsection("Automatic time step");
    prm.add_parameter("Tolerance",
                      tolerance,
                      "How large the error of a step may be: in the fluid's velocity, over its root mean square in the "
                      "domain; in the grains' places, in tenths of their diameter. A step with a larger one is taken "
                      "back.",
                      Patterns::Double(1e-8, 1.));
    prm.add_parameter("Largest path",
                      path,
                      "How far grains may go in a step, in mean diameters: the fluid sees them where they were.",
                      Patterns::Double(1e-6));
    prm.add_parameter(
      "Largest time step",
      largest,
      "No step is longer [s]. 0: Interval of statistics, or, if that is 0, too, a twentieth of the time to the end.",
      Patterns::Double(0.));
    prm.add_parameter(
      "Smallest time step",
      smallest,
      "Shorter steps are not tried [s], but for the time scheme's stability. 0: a millionth of the largest, and where "
      "grains move 1e-2 sqrt(d/g): what they overlap, up to 1e-4 d, opens in one step, and is to do so with less than "
      "g dt.",
      Patterns::Double(0.));
    prm.leave_subsection();
    prm.leave_subsection();
  }


  void TimeStepControl::parse_parameters(const double end_of_run)
  {
    const std::string word = Utilities::trim(text);
    is_automatic           = word == "auto";
    // no longer than the run: with this step the set-up tries what the contacts do
    const auto cut = [&](const double dt) { return end_of_run > 0. ? std::min(dt, end_of_run) : dt; };
    if (is_automatic)
      {
        model.time_step = cut(largest > 0. ? largest : 1e-3);
        return;
      }
    std::size_t end = 0;
    try
      {
        fixed = std::stod(word, &end);
      }
    catch (const std::exception &)
      {
        end = 0;
      }
    check_user(end == word.size() && end > 0 && word.find_first_of("xX") == std::string::npos && fixed >= 1e-12 &&
                 std::isfinite(fixed),
               "Time/Time step: expected `auto` or a number of seconds of at least 1e-12, got '" + text + "'.");
    model.time_step = cut(fixed);
  }


  std::string TimeStepControl::description() const
  {
    return "chosen step by step: errors of at most " + in_digits(100. * tolerance) + " %, paths of at most " +
           in_digits(path) + " diameters, at most " + in_digits(largest) + " s";
  }


  void TimeStepControl::prepare(const double end, const std::vector<double> &output_intervals)
  {
    end_time = end;
    if (!is_automatic)
      return;
    if (largest == 0.)
      largest = !output_intervals.empty() && output_intervals[0] > 0. ? output_intervals[0] : end_time / 20.;
    if (smallest == 0.)
      {
        smallest = 1e-6 * largest;
        if (model.grains_move && model.grains.n() > 0 && model.gravity_size() > 0.)
          smallest =
            std::clamp(1e-2 * std::sqrt(grains::mean_diameter(model.grains) / model.gravity_size()), smallest, largest);
      }
    check_user(smallest <= largest,
               "Time/Automatic time step/Smallest time step: " + in_digits(smallest) + " s is above the largest, " +
                 in_digits(largest) + " s.");
    for (const double interval : output_intervals)
      if (interval > 0.)
        intervals.push_back(interval);
    const SceneNumbers numbers = find_scene_numbers(model, end_time);
    small_speed                = std::max(0.1 * numbers.fluidisation_velocity, 0.01 * numbers.terminal_velocity);
    kinks                      = given_kinks(model, end_time);
    model.time_step_choice     = observers::TimeStepChoice();
  }


  /** The next time at which a step must end. */
  double TimeStepControl::next_event(const double time) const
  {
    const double soon   = same_time * wanted;
    double       result = end_time;
    for (const double interval : intervals)
      {
        double n = std::floor(time / interval) + 1.;
        if (n * interval <= time + soon)
          n += 1.;
        result = std::min(result, n * interval);
      }
    // a kink that lies beside another event, as one that was found to round-off, is met there: what is between them is
    // no step
    const double close = same_kink();
    const auto   kink  = std::upper_bound(kinks.begin(), kinks.end(), time + close);
    return kink != kinks.end() && *kink < result - close ? *kink : result;
  }


  /** How far from a kink a step may end that meets it [s]. */
  double TimeStepControl::same_kink() const
  {
    return std::max(same_time * largest, 0.1 * smallest);
  }


  /** Make the coming step @p dt long, or so much shorter that the next event is met with steps of one length. */
  void TimeStepControl::set(const double dt)
  {
    const double time = model.time, left = next_event(time) - time;
    const double n = std::max(1., std::ceil(left / dt * (1. - same_time)));
    if (n == 1. && left < (1. - 1e-3) * dt)
      coming.limit = "event";
    end_of_this     = n == 1. ? time + left : time + left / n;
    model.time_step = left / n;
  }


  void TimeStepControl::choose()
  {
    if (!is_automatic)
      {
        // the last step ends at the end time; where little would be left for it, it shares with the one before
        constexpr double round_off = 1e-6, little = 0.1;
        const double     left = end_time - model.time;
        double           dt   = fixed;
        if (left < (1. - round_off) * fixed)
          dt = left;
        else if (left > (1. + round_off) * fixed && left < (1. + little) * fixed)
          dt = 0.5 * left;
        if (dt != model.time_step)
          {
            model.time_step = dt;
            model.clock     = {model.time, model.n_steps, dt};
          }
        end_of_this = model.time + model.time_step;
        return;
      }
    dt_before = model.time_step;
    const bool at_kink =
      std::any_of(kinks.begin(), kinks.end(), [&](const double t) { return std::abs(t - model.time) <= same_kink(); });
    is_smooth = has_history && !at_kink;
    if (!is_smooth)
      {
        constexpr double first = 0.05;
        wanted                 = std::clamp(first * largest, smallest, largest);
        coming.limit           = "start";
        controller.set_previous_error(1.);
      }
    constexpr unsigned int stable_interval = 20;
    if (model.n_steps % stable_interval == 0 || !(stable > 0.))
      stable = stable_step(model);
    double dt = wanted;
    if (stable > 0. && stable_share * stable < dt) // 0: no step is stable, which has been warned of
      {
        dt           = stable_share * stable;
        coming.limit = "stability";
      }
    set(dt);
    again = false;
  }


  void TimeStepControl::begin(const bool mesh_has_changed)
  {
    if (!is_automatic)
      {
        if (model.has_fluid)
          model.coupled_step.prepare();
        return;
      }
    if (again)
      return;
    again = true;
    if (model.has_fluid)
      {
        fluid_error.begin(model.solver, dt_before, is_smooth && !mesh_has_changed);
        model.coupled_step.prepare();
      }
    if (model.grains_move)
      start.remember(model.grains, model.contacts);
  }


  void TimeStepControl::take_back(const double factor, const char *reason)
  {
    if (model.has_fluid)
      model.solver.take_back();
    if (model.grains_move)
      start.restore(model.grains, model.contacts);
    ++coming.n_taken_back;
    model.counts["time steps taken back"] += 1;
    coming.limit = reason;
    wanted       = std::max(smallest, factor * model.time_step);
    set(wanted);
  }


  bool TimeStepControl::may_be_shorter() const
  {
    return model.time_step > (1. + 1e-6) * smallest;
  }


  bool TimeStepControl::accepts_fluid()
  {
    // without inertia, the flow through fixed grains is right at any time, however long the step
    const bool is_stationary = !model.grains_move && !model.solver.discretisation.inertia;
    fluid_defect             = is_automatic && model.has_fluid && !is_stationary
                                 ? fluid_error.measure(model.solver, model.time_step, small_speed) / tolerance
                                 : 0.;
    if (fluid_defect <= 1. || !is_automatic || !may_be_shorter())
      return true;
    take_back(PiController::taken_back(fluid_defect), "fluid");
    return false;
  }


  /**
   * How far the semi-implicit Euler method puts the grains from where they should be, dt |v^n+1 - v^n|/2, over a tenth
   * of their diameter.
   */
  double TimeStepControl::grain_error() const
  {
    const double change = fourth_mean(model.grains, [&](const std::size_t i) {
      return std::array<double, 2>{
        {model.grains.velocity[0][i] - start.velocity()[0][i], model.grains.velocity[1][i] - start.velocity()[1][i]}};
    });
    return 0.5 * model.time_step * change / (0.1 * grains::mean_diameter(model.grains));
  }


  /** The step in which the grains go as far as they may. */
  double TimeStepControl::path_step() const
  {
    const double speed = fourth_mean(model.grains, [&](const std::size_t i) {
      return std::array<double, 2>{{model.grains.velocity[0][i], model.grains.velocity[1][i]}};
    });
    return speed > 0. ? path * grains::mean_diameter(model.grains) / speed : infinity;
  }


  bool TimeStepControl::accepts_step()
  {
    if (!is_automatic)
      return true;
    const double     dt           = model.time_step;
    const bool       has_grains   = model.grains_move && model.grains.n() > 0;
    const double     grain_defect = has_grains ? grain_error() / tolerance : 0.;
    const double     longest_path = has_grains ? path_step() : infinity;
    constexpr double much         = 2.; // contacts are expensive: what is a little too much is mended in the next step
    const bool       is_crushed   = has_grains && model.contact_report.crush.depth > 0.;
    if (may_be_shorter() && (grain_defect > much || dt > much * longest_path || is_crushed))
      {
        if (is_crushed)
          take_back(0.25, "contacts");
        else if (grain_defect > much)
          take_back(PiController::taken_back(grain_defect), "grains");
        else
          take_back(std::max(0.2, longest_path / dt), "path");
        return false;
      }
    if (fluid_defect > 1. || grain_defect > much)
      {
        model.counts["time steps above the tolerance"] += 1;
        model.warnings.add(
          "chosen time steps had a larger error than Time/Automatic time step/Tolerance, since shorter ones "
          "than its `Smallest time step` are not tried",
          model.time);
      }

    std::vector<Limit> limits;
    const double       factor = controller.accepted(std::max(fluid_defect, grain_defect));
    limits.push_back({factor >= PiController::largest_factor ? "growth"
                      : fluid_defect >= grain_defect         ? "fluid"
                                                             : "grains",
                      // an event may have made this step shorter than it had to be
                      std::max(factor * dt, coming.limit == "event" && factor >= 1. ? wanted : 0.)});
    limits.push_back({"path", longest_path});
    limits.push_back({"largest", largest});
    if (has_grains && model.contact_report.n_unconverged > 0)
      limits.push_back({"contacts", 0.5 * dt});
    else if (has_grains && model.contact_report.n_halvings > 0)
      limits.push_back({"contacts", dt});
    const Limit least =
      *std::min_element(limits.begin(), limits.end(), [](const Limit &a, const Limit &b) { return a.dt < b.dt; });

    model.time_step_choice         = coming;
    model.time_step_choice->margin = std::isfinite(stable) ? stable / dt : 0.;
    // a preconditioner, and a step that is the last one once more, are worth more than a little length
    constexpr double little = 1.2;
    wanted = std::max(smallest, least.dt > dt && least.dt < little * dt && coming.limit != "event" ? dt : least.dt);
    coming.limit = least.name;
    fluid_error.accept();
    has_history = true;
    model.clock = {end_of_this, model.n_steps + 1, dt};
    return true;
  }


  bool TimeStepControl::rescue()
  {
    if (!is_automatic || !may_be_shorter())
      return false;
    take_back(0.25, "failure");
    return true;
  }


  void TimeStepControl::save(nlohmann::ordered_json &state) const
  {
    if (is_automatic)
      state["time step control"] = {
        {"dt", model.time_step},
        {"wanted", wanted},
        {"limit", coming.limit},
        {"taken back", coming.n_taken_back},
        {"error", controller.previous_error()},
        {"speed", fluid_error.largest_speed()},
        {"small speed", small_speed}, // these two are of the grains at t = 0
        {"smallest", smallest},
        {"stable", std::isfinite(stable) ? stable : -1.},
      };
  }


  void TimeStepControl::load(const nlohmann::ordered_json &state)
  {
    if (!is_automatic || !state.contains("time step control"))
      return;
    const auto &saved   = state.at("time step control");
    model.time_step     = saved.at("dt");
    wanted              = saved.at("wanted");
    coming.limit        = saved.at("limit");
    coming.n_taken_back = saved.at("taken back");
    controller.set_previous_error(saved.at("error"));
    fluid_error.set_largest_speed(saved.at("speed"));
    small_speed = saved.at("small speed");
    smallest    = saved.at("smallest");
    has_history = true;
    stable      = saved.at("stable");
    if (stable < 0.)
      stable = infinity;
  }
} // namespace alluvium::run
