#include <alluvium/fluid/flow_terms.h>
#include <alluvium/run/model.h>
#include <alluvium/run/model_choice.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    /** Steps in which flow and grains find each other from rest: they are iterated, and nothing is measured in them. */
    constexpr unsigned int n_first_steps = 3;

    Term term_of(const std::string &name)
    {
      const auto found =
        std::find_if(all_terms.begin(), all_terms.end(), [&](const Term term) { return name_of(term) == name; });
      AssertThrow(found != all_terms.end(), ExcInternalError());
      return *found;
    }

    std::string names(const std::string &separator)
    {
      std::string result;
      for (const Term term : all_terms)
        result += (result.empty() ? "" : separator) + name_of(term);
      return result;
    }

    std::string in_words(const double estimate)
    {
      return std::isnan(estimate) ? "-" : rounded(100. * estimate) + " %";
    }

    double root_mean_square_speed(const grains::GrainArrays &grains)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < grains.n(); ++i)
        sum += grains.velocity[0][i] * grains.velocity[0][i] + grains.velocity[1][i] * grains.velocity[1][i];
      return grains.n() > 0 ? std::sqrt(sum / grains.n()) : 0.;
    }
  } // namespace


  void ModelChoice::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Model",
                      model_text,
                      "`full`: all that the other parameters ask for; `auto`: of that, what is estimated to change "
                      "results by less than a tenth of `Automatic model/Accuracy` is left out, is looked after during "
                      "the run, and is switched on if it comes to more. The report says which, and why.",
                      Patterns::Selection("full|auto"));
    prm.enter_subsection("Automatic model");
    prm.add_parameter("Accuracy",
                      accuracy,
                      "How far results may be from those of the full model [-]; each term that is left out may take a "
                      "tenth of it. If Accuracy is set, it is that unless it is set here.",
                      Patterns::Double(1e-12, 1.));
    prm.add_parameter("Keep",
                      keep_text,
                      "Terms that are not left out, separated by commas: " + names(", ") + ".",
                      Patterns::MultipleSelection(names("|")));
    prm.leave_subsection();
  }


  void ModelChoice::parse_parameters()
  {
    is_automatic = model_text == "auto";
    keep.clear();
    for (const std::string &name : Utilities::split_string_list(keep_text))
      keep.push_back(term_of(name));
  }


  void ModelChoice::choose_fluid(Model &model)
  {
    if (!is_automatic || !model.has_fluid)
      return;
    const auto table = estimate_terms(find_scene_scales(model, {model.time, 0., false}), 0.1 * accuracy, keep);
    leaves_out_fluid = !table.front().on;
    model.has_fluid  = !leaves_out_fluid;
  }


  void ModelChoice::choose(Model &model, const Schedule &schedule)
  {
    if (!is_automatic)
      return;
    model.has_fluid   = model.has_fluid || leaves_out_fluid; // as asked for
    SceneScales scene = find_scene_scales(model, schedule);
    model.has_fluid   = model.has_fluid && !leaves_out_fluid;
    table.clear();
    for (const TermEstimate &term : estimate_terms(scene, 0.1 * accuracy, keep))
      table.push_back({term});
    apply(model);
  }


  bool ModelChoice::is_on(const Term term) const
  {
    return std::none_of(table.begin(), table.end(), [&](const Row &r) { return r.term.term == term && !r.term.on; });
  }


  bool ModelChoice::is_left_out(const Term term) const
  {
    return std::any_of(table.begin(), table.end(), [&](const Row &r) {
      return r.term.term == term && !r.term.on && r.term.is_asked;
    });
  }


  ModelChoice::Row *ModelChoice::row(const Term term)
  {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Row &r) { return r.term.term == term; });
    return found == table.end() ? nullptr : &*found;
  }


  /** Make the parts of @p model do what the table says. */
  void ModelChoice::apply(Model &model) const
  {
    auto &terms      = model.solver.discretisation;
    terms.convection = terms.convection && is_on(Term::convection);
    terms.inertia    = terms.inertia && is_on(Term::inertia);
    terms.viscosity  = terms.viscosity && is_on(Term::viscous_stress);
    model.coupled_step.iteration().leave_out(!is_on(Term::iteration) && model.n_steps >= n_first_steps);
    model.contacts.leave_out(model.grains_move && !is_on(Term::contacts) && model.contacts.may_be_left_out());
  }


  void ModelChoice::switch_on(
    const Term term, const double estimate, const std::string &because, Model &model, std::vector<Switch> &switched)
  {
    Row &r          = *row(term);
    r.term.on       = true;
    r.term.estimate = estimate;
    r.term.because  = because;
    r.since         = model.time;
    auto &terms     = model.solver.discretisation;
    if (term == Term::convection)
      terms.convection = true;
    if (term == Term::inertia)
      terms.inertia = true;
    if (term == Term::viscous_stress)
      terms.viscosity = true;
    if (term == Term::convection || term == Term::inertia || term == Term::viscous_stress)
      {
        model.solver.linear_solver.clear(); // another matrix
        model.coupling.forget_steady();
      }
    if (term == Term::iteration)
      model.coupled_step.iteration().leave_out(false);
    if (term == Term::contacts)
      model.contacts.leave_out(false);
    switched.push_back({term,
                        "t = " + in_digits(model.time) + " s: " + name_of(term) + " switched on, estimate " +
                          run::in_words(estimate) + ": " + because});
  }


  /** What the terms that the flow is solved without would do to it. */
  void ModelChoice::watch_flow(Model &model, std::vector<Switch> &switched)
  {
    constexpr unsigned int interval = 10; // steps: it costs as much as to assemble them
    if (!(is_left_out(Term::convection) || is_left_out(Term::inertia) || is_left_out(Term::viscous_stress)) ||
        model.n_steps <= n_first_steps || model.coupling.report().steady)
      return;
    // between them a flow that changes by much, by a pulse say
    constexpr double much  = 0.1;
    const double     speed = model.solver.solution().block(0).l2_norm();
    if (model.n_steps > 20 && model.n_steps % interval != 0 &&
        std::abs(speed - speed_when_looked_at) <= much * std::max(speed, speed_when_looked_at))
      return;
    speed_when_looked_at = speed;
    const fluid::FlowTerms terms = fluid::flow_terms(model.space,
                                                     model.solver.problem(),
                                                     model.solver.solution(),
                                                     model.coupling.flow_before_step(),
                                                     model.solver.linear_solver.scales.volumes);
    const double           scale = terms.largest();
    if (!(scale > 0.))
      return;
    const double bound = 0.1 * accuracy;
    const auto   look  = [&](const Term term, const double size) {
      if (!is_left_out(term))
        return;
      Row &r = *row(term);
      r.most = std::max(r.most, size / scale);
      if (!(size / scale < bound))
        switch_on(term, size / scale, "its force over the largest of the flow, root mean square", model, switched);
    };
    look(Term::convection, terms.convection);
    look(Term::inertia, terms.inertia);
    look(Term::viscous_stress, terms.viscosity);
  }


  std::vector<ModelChoice::Switch> ModelChoice::watch(Model &model)
  {
    std::vector<Switch> switched;
    if (!is_automatic)
      return switched;
    const double bound = 0.1 * accuracy;
    if (model.has_fluid)
      watch_flow(model, switched);
    if (model.grains_move && is_left_out(Term::contacts) && !model.contacts.are_left_out())
      {
        switch_on(
          Term::contacts, 1., "two grains, or a grain and a wall, might have met in this step", model, switched);
        // and with them what they bring
        if (is_left_out(Term::friction))
          switch_on(Term::friction, 1., "grains may touch", model, switched);
        if (is_left_out(Term::rotation) && is_on(Term::friction))
          switch_on(Term::rotation, 1., "friction turns grains", model, switched);
      }
    if (model.n_steps == n_first_steps)
      model.coupled_step.iteration().leave_out(!is_on(Term::iteration));
    else if (model.n_steps > n_first_steps && model.has_fluid && model.grains_move && is_left_out(Term::iteration))
      {
        const auto  &iteration = model.coupled_step.iteration();
        const double estimate  = iteration_estimate(iteration.defect_left(),
                                                   root_mean_square_speed(model.grains),
                                                   model.time_step,
                                                   grains::mean_diameter(model.grains));
        Row         &r         = *row(Term::iteration);
        r.most                 = std::max(r.most, estimate);
        if (!(estimate < bound))
          switch_on(Term::iteration,
                    estimate,
                    "the force that the fluid has not seen moves grains by this of their diameter",
                    model,
                    switched);
        else if (model.coupling.report().eps_min < least_eps_without_iteration)
          switch_on(Term::iteration,
                    estimate,
                    "void fraction " + rounded(model.coupling.report().eps_min) + " is below " +
                      rounded(least_eps_without_iteration) + ", above which a step is stable without",
                    model,
                    switched);
      }
    return switched;
  }


  std::vector<std::string> ModelChoice::in_words() const
  {
    std::vector<std::array<std::string, 3>> cells = {{{"term", "on or off", "estimate"}}};
    for (const Row &r : table)
      cells.push_back({{name_of(r.term.term),
                        (r.term.on ? "on" : "off") +
                          std::string(std::isnan(r.since) ? "" : " since t = " + in_digits(r.since) + " s"),
                        run::in_words(r.term.estimate)}});
    std::array<std::size_t, 3> width{};
    for (const auto &row : cells)
      for (unsigned int c = 0; c < 3; ++c)
        width[c] = std::max(width[c], row[c].size());
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < cells.size() && !table.empty(); ++i)
      {
        std::string line;
        for (unsigned int c = 0; c < 3; ++c)
          line += cells[i][c] + std::string(width[c] - cells[i][c].size(), ' ') + " | ";
        lines.push_back(line + (i == 0 ? "because" : table[i - 1].term.because));
      }
    return lines;
  }


  void ModelChoice::save(const Model &model, nlohmann::ordered_json &state) const
  {
    if (!is_automatic)
      return;
    auto &saved               = state["model"];
    saved["leaves out fluid"] = leaves_out_fluid;
    saved["grains move"]      = model.grains_move;
    saved["flow looked at"]   = speed_when_looked_at;
    for (const Row &r : table)
      saved["terms"][name_of(r.term.term)] = {
        r.term.on, r.term.is_asked, r.term.estimate, r.term.because, r.since, r.most};
  }


  void ModelChoice::load_fluid(const nlohmann::ordered_json &state, Model &model)
  {
    const bool was_left_out = state.contains("model") && state.at("model").at("leaves out fluid").get<bool>();
    check_user(!was_left_out || is_automatic || !model.has_fluid,
               "Output/Restart: the run left the fluid out (Model = auto), and what it began with cannot be had back. "
               "Keep Model = auto, or start anew.");
    leaves_out_fluid = was_left_out;
    model.has_fluid  = model.has_fluid && !was_left_out;
  }


  bool ModelChoice::load(const nlohmann::ordered_json &state, Model &model)
  {
    table.clear();
    if (!is_automatic || !state.contains("model"))
      return true; // a run that was full stays so
    if (state.at("model").at("grains move").get<bool>() != model.grains_move)
      return false;
    speed_when_looked_at = state.at("model").value("flow looked at", 0.);
    const auto number = [](const nlohmann::ordered_json &x) {
      return x.is_null() ? std::numeric_limits<double>::quiet_NaN() : x.get<double>();
    };
    for (const auto &[name, saved] : state.at("model").at("terms").items())
      table.push_back({{term_of(name),
                        saved.at(0).get<bool>(),
                        saved.at(1).get<bool>(),
                        number(saved.at(2)),
                        saved.at(3).get<std::string>()},
                       number(saved.at(4)),
                       number(saved.at(5))});
    apply(model);
    return true;
  }
} // namespace alluvium::run
