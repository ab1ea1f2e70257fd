#include <alluvium/observers/line_average.h>
#include <alluvium/output/fluid_output.h>
#include <alluvium/output/wall_output.h>
#include <alluvium/run/bed_flow.h>
#include <alluvium/run/model.h>
#include <alluvium/run/output.h>
#include <alluvium/utilities/first_rank.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/reference_cell.h>
#include <deal.II/grid/tria.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  Output::Output(Model &model)
    : model(model)
  {}


  void Output::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Output");
    prm.add_parameter("Interval of pictures",
                      picture_interval,
                      "Time between two outputs of the fields for ParaView [s], one more at the end; 0: none.",
                      Patterns::Double(0.));
    prm.add_parameter("Interval of statistics",
                      row_interval,
                      "Time between two rows of statistics.csv [s]; 0: every step.",
                      Patterns::Double(0.));
    prm.add_parameter("Format",
                      format,
                      "Files of the fluid's fields: .vtu, or HDF5 with XDMF for big runs.",
                      Patterns::Selection("vtu|hdf5"));
    prm.add_parameter("Digits", precision, "Significant digits in statistics.csv.", Patterns::Integer(3, 17));
    prm.add_parameter(
      "Head between",
      head_between,
      "Names of two boundaries: the differential head is the mean of p/(rho g) + u^2/(2 g) over the "
      "first less that over the second, p without its hydrostatic part. Empty: between the bottom and "
      "the top that the bed had at t = 0, which has a meaning only where gravity points along an axis, the "
      "bed reaches from side to side and no flow goes past it: elsewhere no head is reported.");
    output_folder.add_parameters(prm);
    choice.add_parameters(prm,
                          "Observers",
                          "head, motion, support, flux, bed, audit, leavers, walls, time step",
                          "What to measure; those that a scene gives nothing to are left out.",
                          true);
    prm.leave_subsection();
  }


  void Output::parse_parameters()
  {
    const auto names = Utilities::split_string_list(head_between);
    check_user(names.empty() || names.size() == 2,
               "Output/Head between: expected the names of two boundaries, got '" + head_between + "'.");
    check_user(names.empty() || names[0] != names[1],
               "Output/Head between: a head is between two boundaries, but '" + head_between + "' is one.");
    choice.parse_parameters();
  }


  void Output::choose_observers()
  {
    if (model.has_fluid)
      fluid_view = std::make_unique<observers::FluidView>(
        observers::FluidView{model.space, model.solver, model.boundary_conditions, model.coupling});
    choose_head();
    observing.clear();
    for (observers::Observer *observer : choice.all())
      if (observer->applies(snapshot()))
        {
          observing.push_back(observer);
          model.watches_mesh_changes = model.watches_mesh_changes || observer->watches_mesh_changes();
        }
  }


  std::string Output::observers() const
  {
    std::string names, idle;
    for (const auto &name : Utilities::split_string_list(choice.name()))
      {
        const bool   works = std::count(observing.begin(), observing.end(), &choice.get(name)) > 0;
        std::string &list  = works ? names : idle;
        list += (list.empty() ? "" : ", ") + name;
      }
    return names + (idle.empty() ? "" : "; left out, with nothing to measure here: " + idle);
  }


  std::string Output::check_folder(const bool is_restart, const bool may_hold_a_run)
  {
    return output_folder.check(model.communicator, is_restart, may_hold_a_run);
  }


  void Output::make_folder(const bool is_restart)
  {
    output_folder.create(model.communicator, is_restart);
  }


  bool Output::holds_finished_run() const
  {
    output::Summary left(output_folder.file("summary.json"), model.communicator);
    left.resume();
    return left.text("ended") == "finished";
  }


  void Output::open()
  {
    const bool hdf5 = format == "hdf5";
    statistics =
      std::make_unique<output::Statistics>(output_folder.file("statistics.csv"), model.communicator, precision);
    summary        = std::make_unique<output::Summary>(output_folder.file("summary.json"), model.communicator);
    grain_pictures = std::make_unique<output::FieldSeries>(output_folder.path(), "grains", hdf5, model.communicator);
    fluid_pictures = std::make_unique<output::FieldSeries>(output_folder.path(), "fluid", hdf5, model.communicator);
    wall_pictures  = std::make_unique<output::FieldSeries>(output_folder.path(), "walls", hdf5, model.communicator);
    statistics->add_column("time_s");
    for (auto *observer : observing)
      observer->add_columns(snapshot(), *statistics);
  }


  /** Where a head has a meaning. */
  void Output::choose_head()
  {
    head_ids.clear();
    const auto  names = Utilities::split_string_list(head_between);
    std::string known;
    for (const auto &[name, id] : model.domain.boundary_ids())
      known += (known.empty() ? "'" : ", '") + name + "'";
    for (const auto &name : names)
      check_user(model.domain.boundary_ids().count(name) == 1,
                 "Output/Head between: there is no boundary named '" + name + "'. The domain's boundaries are " +
                   known + ".");
    if (!fluid_view || model.gravity_size() == 0.)
      {
        check_user(names.empty(), "Output/Head between: without fluid or without gravity there is no head.");
        return;
      }
    for (const auto &name : names)
      head_ids.push_back(model.domain.boundary_ids().at(name));
    const BedFlow flow      = flow_across_bed(model);
    fluid_view->head_of_bed = names.empty() && flow.has_head;
    fluid_view->crosses_bed = flow.crosses;
    if (fluid_view->head_of_bed || !names.empty())
      fluid_view->head = 0.;
  }


  std::string Output::where_head() const
  {
    if (!fluid_view)
      return "";
    if (!head_ids.empty())
      return "between the boundaries " + head_between;
    if (fluid_view->head_of_bed)
      return "between bottom and top of the bed";
    return "not reported: the bed is none that a flow crosses from bottom to top. See Output/Head between";
  }


  double Output::head() const
  {
    const double g = model.gravity_size(), rho = model.solver.properties.density;
    if (head_ids.empty() && !fluid_view->head_of_bed)
      return std::numeric_limits<double>::quiet_NaN();
    // y + p/(rho g) is the reduced pressure over rho g
    const auto psi = [&](const std::array<double, Model::dim> &u, const double p) {
      return p / (rho * g) + (u[0] * u[0] + u[1] * u[1]) / (2. * g);
    };
    if (!head_ids.empty())
      return observers::boundary_average<Model::dim>(model.space, model.solver.solution(), head_ids[0], psi) -
             observers::boundary_average<Model::dim>(model.space, model.solver.solution(), head_ids[1], psi);
    const auto average = [&](const double height) {
      const auto &upright = model.initial_bed.upright;
      return observers::line_average<Model::dim>(
        model.space, model.solver.solution(), upright.sign * height, psi, upright.vertical);
    };
    return average(model.initial_bed.bottom()) - average(model.initial_bed.top());
  }


  observers::Snapshot Output::snapshot() const
  {
    return {model.time,
            model.time_step,
            model.n_steps,
            model.grains,
            model.initial_bed,
            model.domain.lower()[1 - model.upright().vertical],
            model.domain.upper()[1 - model.upright().vertical],
            model.domain.lower()[1],
            model.domain.upper()[1],
            model.gravity,
            model.grains_move ? &model.contact_report : nullptr,
            fluid_view.get(),
            model.grains_move ? &model.contacts : nullptr,
            output_folder.path(),
            model.communicator,
            model.mesh_change ? &*model.mesh_change : nullptr,
            model.leavers,
            model.contacts.walls(),
            model.time_step_choice ? &*model.time_step_choice : nullptr};
  }


  void Output::observe()
  {
    const auto timer = model.timers.scope("observers");
    if (model.has_fluid)
      {
        fluid_view->head = head();
        if (model.n_steps > 0)
          {
            drag_impulse += model.time_step * model.coupling.report().force_scale;
            drag_impulse_outside += model.time_step * model.coupling.report().force_outside_range;
          }
      }
    for (auto *observer : observing)
      observer->observe(snapshot());
  }


  void Output::write_row()
  {
    const auto timer = model.timers.scope("observers");
    statistics->set("time_s", model.time);
    for (auto *observer : observing)
      observer->write(snapshot(), *statistics);
    statistics->write_row();
  }


  void Output::write_pictures()
  {
    const auto timer = model.timers.scope("pictures");
    model.store.output([&](auto &data) { grain_pictures->write<0>(data, ReferenceCells::Vertex, model.time); });
    // what stands still and is the boundary is seen in the fluid's pictures, or known
    const auto &walls = model.contacts.walls();
    if (std::any_of(walls.begin(), walls.end(), [&](const auto &wall) {
          return grains::ever_acts(wall) || model.domain.boundary_ids().count(wall.name) == 0;
        }))
      output::write_walls(*wall_pictures, walls, model.time, model.communicator);
    if (model.has_fluid)
      output::write_fluid(*fluid_pictures,
                          model.space,
                          model.solver.solution(),
                          model.coupling.void_fraction(),
                          model.solver.background_gradient(),
                          model.solver.datum(),
                          model.time);
  }


  void Output::write_beginning()
  {
    observe();
    write_row();
    if (picture_interval > 0.)
      write_pictures();
  }


  void Output::update()
  {
    observe();
    if (is_due(model.time, model.time_step, row_interval))
      write_row();
    has_pictures = picture_interval > 0. && is_due(model.time, model.time_step, picture_interval);
    if (has_pictures)
      write_pictures();
  }


  void Output::fill_summary(const Ending &ending, const std::map<std::string, Timers::Phase> &phases)
  {
    summary->clear();
    summary->set("ended", ending.how);
    summary->set("reason", ending.reason);
    summary->set("time_s", model.time);
    if (ending.exit_code >= 0)
      summary->set("exit_code", ending.exit_code);
    for (const auto &[path, number] : extra_numbers)
      summary->set(path, number);
    for (const auto &[path, text] : extra_texts)
      summary->set(path, text);
    for (auto *observer : observing)
      observer->conclude(*summary);
    summary->set("run/time_s", model.time);
    summary->set("run/steps", model.n_steps);
    summary->set("run/interrupted", ending.how == "interrupted");
    summary->set("run/ranks", Utilities::MPI::n_mpi_processes(model.communicator));
    const auto lower = model.domain.lower(), upper = model.domain.upper();
    summary->set("domain/lower_m", std::vector<double>{lower[0], lower[1]});
    summary->set("domain/upper_m", std::vector<double>{upper[0], upper[1]});
    summary->set("scene/grains", model.grains.n());
    if (model.has_fluid)
      {
        summary->set("scene/cells", static_cast<unsigned long>(model.triangulation->n_global_active_cells()));
        summary->set("scene/unknowns", static_cast<unsigned long>(model.space.n_dofs()));
        summary->set("scene/pieces", model.coupling.report().n_pieces);
      }
    for (const auto &[name, count] : model.counts)
      summary->set("counts/" + name, count);
    for (const auto &[name, phase] : phases)
      {
        summary->set("timing/" + name + "/wall_s", phase.wall);
        summary->set("timing/" + name + "/cpu_s", phase.cpu);
      }
    if (model.has_fluid)
      warn_of_drag_range();
  }


  void Output::conclude(const Ending &ending)
  {
    // not in the checkpoint: a run that goes on is as one that has never ended here
    if (picture_interval > 0. && !has_pictures && ending.how == "finished")
      write_pictures();
    model.timers.add(model.solver.timers);
    const auto phases = model.timers.slowest(model.communicator);
    fill_summary(ending, phases);
    // these are known only now; the others have been said
    for (const auto &text : summary->warnings())
      model.warnings.print(text);
    for (const auto &warning : model.warnings.all())
      summary->warn(Warnings::in_words(warning));
    on_first_rank(model.communicator, [&] { summary->write(); });
    if (model.is_root)
      {
        double total = 0.;
        for (const auto &[name, phase] : phases)
          total += name.find(": ") == std::string::npos ? phase.wall : 0.;
        print_timers(std::cout, phases, total);
      }
  }


  void Output::write_summary_alone(const Ending &ending)
  {
    if (!model.is_root)
      return;
    fill_summary(ending, model.timers.all());
    for (const auto &warning : model.warnings.all())
      summary->warn(Warnings::in_words(warning));
    summary->write();
  }


  void Output::warn_of_drag_range()
  {
    const std::size_t n_outside = model.coupling.outside_drag_range(model.grains).size();
    const double      share     = drag_impulse > 0. ? drag_impulse_outside / drag_impulse : 0.;
    summary->set("drag law/grains_ever_outside_its_range", n_outside);
    summary->set("drag law/share_of_drag_outside_its_range", share);
    // grains at a surface, or starting to move, are outside it for a while in any run
    constexpr double substantial = 0.2;
    if (share <= substantial)
      return;
    const coupling::DragRange range = model.coupling.drag_law().range();
    std::ostringstream        text;
    text.precision(3);
    text << 100. * share << " % of the fluid's force on the grains acted outside the range of the drag law '"
         << model.coupling.drag_law_name() << "' (void fraction " << range.eps_min << " to " << range.eps_max
         << ", Reynolds number " << range.re_min << " to " << range.re_max << "), on " << n_outside << " of "
         << model.grains.n() << " grains.";
    summary->warn(text.str());
  }


  void Output::save(nlohmann::ordered_json &state) const
  {
    state["grain pictures"] = grain_pictures->state();
    state["fluid pictures"] = fluid_pictures->state();
    state["wall pictures"]  = wall_pictures->state();
    for (const auto &name : Utilities::split_string_list(choice.name()))
      choice.get(name).save(state["observers"][name]);
    state["drag impulse"] = {drag_impulse, drag_impulse_outside};
    state["warnings"]     = nlohmann::ordered_json::array();
    for (const auto &warning : model.warnings.all())
      state["warnings"].push_back({warning.text, warning.count, warning.first_time});
  }


  void Output::load(const nlohmann::ordered_json &state)
  {
    grain_pictures->resume(state.at("grain pictures"));
    fluid_pictures->resume(state.at("fluid pictures"));
    if (state.contains("wall pictures"))
      wall_pictures->resume(state.at("wall pictures"));
    for (const auto &name : Utilities::split_string_list(choice.name()))
      if (!state.at("observers").at(name).is_null())
        choice.get(name).load(state.at("observers").at(name));
    drag_impulse         = state.at("drag impulse").at(0);
    drag_impulse_outside = state.at("drag impulse").at(1);
    std::vector<Warnings::Warning> warnings;
    for (const auto &w : state.at("warnings"))
      warnings.push_back({w.at(0), w.at(1), w.at(2)});
    model.warnings.set(warnings);
    statistics->resume(model.time);
  }


  bool is_due(const double time, const double dt, const double interval)
  {
    const double eps = 1e-6 * dt;
    return interval == 0. || std::floor((time + eps) / interval) > std::floor((time - dt + eps) / interval);
  }
} // namespace alluvium::run
