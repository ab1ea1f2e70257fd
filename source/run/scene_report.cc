#include <alluvium/grains/packing.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/model.h>
#include <alluvium/run/model_choice.h>
#include <alluvium/run/output.h>
#include <alluvium/run/scene_numbers.h>
#include <alluvium/run/scene_report.h>
#include <alluvium/run/time_step_control.h>
#include <alluvium/utilities/digits.h>

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <sstream>

namespace alluvium::run
{
  namespace
  {
    std::string in_words(const fluid::BoundaryConditions<Model::dim>::Condition &condition)
    {
      return condition.kind->in_words() + (condition.text.empty() ? "" : " " + condition.text) +
             (condition.add_hydrostatic ? " above hydrostatic" : "");
    }

    /** Every boundary of the domain with what it is to fluid and grains. */
    std::vector<std::string> boundaries(const Model &m)
    {
      std::set<std::string> walls;
      for (const auto &wall : m.contacts.walls())
        walls.insert(wall.name);
      std::vector<std::string> lines;
      for (const auto &[name, id] : m.domain.boundary_ids())
        {
          const auto  condition = m.boundary_conditions.all().find(id);
          std::string text      = name + ": ";
          if (m.has_fluid && condition != m.boundary_conditions.all().end())
            text += in_words(condition->second) + ", ";
          const auto &open  = m.domain.open_to_grains_names();
          const bool  opens = std::count(open.begin(), open.end(), name) > 0;
          // a part of a side has no wall of its own: it is the side's
          lines.push_back(text + (!opens               ? "a wall for grains"
                                  : !walls.count(name) ? "open to grains"
                                                       : "a wall for grains at times"));
        }
      return lines;
    }

    std::string interval(const double from, const double to)
    {
      return (std::isfinite(from) ? " from " + in_digits(from) + " s" : "") +
             (std::isfinite(to) ? (std::isfinite(from) ? " to " : " until ") + in_digits(to) + " s" : "");
    }

    std::string in_words(const grains::WallMotion &motion, const bool rigid)
    {
      std::string text;
      for (const auto &phase : motion.phases)
        {
          if (phase.at_time)
            text += ", moves by a formula";
          else
            {
              const auto &v = phase.velocity;
              if (v[0] != 0. || v[1] != 0.)
                text += ", moves at (" + in_digits(v[0]) + ", " + in_digits(v[1]) + ") m/s";
              if (v[2] != 0.)
                text += ", turns at " + in_digits(v[2]) + " rad/s";
            }
          text += interval(phase.from, phase.to);
        }
      if (rigid)
        text += ", as a whole";
      if (motion.comes_or_goes())
        text += ", there" + interval(motion.present_from, motion.present_to);
      return text;
    }

    bool is_belt(const grains::WallSegment &wall)
    {
      const auto &phases = wall.motion->phases;
      return !phases.empty() && !wall.rigid && std::all_of(phases.begin(), phases.end(), [&](const auto &phase) {
        const auto &v = phase.velocity;
        return !phase.at_time && v[2] == 0. && (wall.b[0] - wall.a[0]) * v[1] == (wall.b[1] - wall.a[1]) * v[0];
      });
    }

    /** Walls that are no boundaries, and those that move. */
    std::vector<std::string> other_walls(const Model &m)
    {
      constexpr std::size_t    most = 20;
      std::vector<std::string> lines;
      std::size_t              n = 0;
      for (const auto &wall : m.contacts.walls())
        {
          const bool moves    = grains::ever_acts(wall);
          const bool boundary = m.domain.boundary_ids().count(wall.name) > 0;
          if ((boundary && !moves) || ++n > most)
            continue;
          std::string text = wall.name + ": (" + in_digits(wall.a[0]) + ", " + in_digits(wall.a[1]) + ") -> (" +
                             in_digits(wall.b[0]) + ", " + in_digits(wall.b[1]) + ") m";
          if (wall.motion)
            text += in_words(*wall.motion, wall.rigid) + (is_belt(wall) ? ", as a belt: it stays where it is" : "");
          lines.push_back(text + (boundary ? "" : ", for grains only"));
        }
      if (n > most)
        lines.push_back("and " + std::to_string(n - most) + " more");
      return lines;
    }
  } // namespace


  double report_scene(const Model           &m,
                      const Output          &output,
                      const TimeStepControl &control,
                      const ModelChoice     &choice,
                      const double           end_time,
                      std::ostream          &out)
  {
    const double       stable  = control.automatic() ? stable_step(m) : 0.;
    const double       longest = stable > 0. ? stable_share * stable : std::numeric_limits<double>::infinity();
    const SceneNumbers s       = find_scene_numbers(m, end_time, longest); // collective
    if (!m.is_root)
      return s.time;
    const auto line = [&](const std::string &what, const std::string &text) {
      out << "  " << what << std::string(what.size() < 12 ? 12 - what.size() : 1, ' ') << text << '\n';
    };
    const auto lines = [&](const std::string &what, const std::vector<std::string> &texts) {
      for (std::size_t i = 0; i < texts.size(); ++i)
        line(i == 0 ? what : "", texts[i]);
    };
    lines("accuracy", m.accuracy);
    const std::string body = s.is_suspension ? "suspension" : "bed";
    line("grains",
         m.grain_setup.unit_length() > 0.
           ? "none; sizes in grain diameters are in units of " + in_digits(m.initial_diameter) + " m"
           : std::to_string(m.grains.n()) + " discs, mean diameter " + in_digits(s.diameter) + " m, fluid radius " +
               in_digits(s.radius_factor) + " of the contact radius");
    if (s.bed.solid > 0.)
      {
        const double inside = grains::inner_packing_fraction(grains::turned(m.grains, m.upright()));
        line(body,
             (m.initial_bed.empty()
                ? std::string()
                : in_digits(m.initial_bed.bottom()) + " m to " + in_digits(m.initial_bed.top()) + " m, ") +
               "packing fraction " + in_digits(s.bed.fraction()) +
               (s.radius_factor < 1. ? " (" + in_digits(s.bed.fluid_fraction()) + " for the fluid)" : "") +
               (inside > 0. ? ", " + in_digits(inside) + " inside" : ""));
      }
    if (m.has_fluid)
      {
        line("fluid",
             "volume-averaged Navier-Stokes, " + std::to_string(m.triangulation->n_global_active_cells()) + " cells, " +
               std::to_string(m.space.n_dofs()) + " unknowns" +
               (m.solver.discretisation.convection
                  ? ""
                  : std::string("; without convection") + (choice.automatic() ? "" : ", as asked")));
        line("coupling",
             std::to_string(m.coupling.report().n_pieces) + " pieces of grains, void fraction " +
               in_digits(m.coupling.report().eps_min) + " to " + in_digits(m.coupling.report().eps_max) +
               ", rho d^2/eta " + in_digits(s.viscous_time) + " s");
        const coupling::DragRange range = m.coupling.drag_law().range();
        line("drag law",
             m.coupling.drag_law_name() + " (void fraction " + in_digits(range.eps_min) + " to " +
               in_digits(range.eps_max) + ", Reynolds number to " + in_digits(range.re_max) + ")" +
               (!s.has_drag  ? "; no drag: the fluid reaches grains through its pressure only"
                : s.eps < 1. ? "; " + body + " of void fraction " + in_digits(s.eps) + ": permeability " +
                                 in_digits(s.permeability) + " m^2, " + (s.is_suspension ? "held up" : "fluidised") +
                                 " at a superficial velocity of " + in_digits(s.fluidisation_velocity) + " m/s" +
                                 (range.contains(s.eps, range.re_min) ? "" : "; it lies outside the law's range")
                             : ""));
        if (s.critical_gradient > 0.)
          line("heave",
               "critical gradient " + rounded(s.critical_gradient) +
                 "; Terzaghi's, (s - 1)(1 - n) with s = " + rounded(s.density_ratio) +
                 " and 1 - n = " + rounded(s.bed.fluid_fraction()) + ": " + rounded(s.terzaghi) +
                 (std::abs(s.critical_gradient / s.terzaghi - 1.) < 1e-3
                    ? ", the same"
                    : ". They differ as the grains' mass follows the contact radius, so that the bed weighs as one "
                      "packed " +
                        rounded(s.bed.fraction()) +
                        ", while the fluid sees 1 - n; with Grains/Mass follows = fluid radius they are the same"));
        if (s.archimedes > 0.)
          line("grain",
               "Archimedes number " + rounded(s.archimedes) +
                 (s.terminal_velocity > 0.
                    ? "; alone it sinks at " + rounded(s.terminal_velocity) + " m/s: Reynolds number " +
                        rounded(s.reynolds) + ", Stokes number tau_p w/d " + rounded(s.stokes)
                    : "") +
                 "; Shields number 1 is a shear stress of " + rounded(s.shields_stress) + " Pa");
        line("time step",
             (control.automatic() ? control.description() + "; with " : "") + in_digits(m.time_step) + " s" +
               (s.relaxation_time > 0.
                  ? ": " + rounded(m.time_step / s.relaxation_time) + " tau_p (" + rounded(s.relaxation_time) + " s" +
                      (s.eps < 1. ? ", in the " + body + ")" : ")")
                  : "") +
               (s.courant > 0.
                  ? "; Courant number " + rounded(s.courant) + " at " + rounded(s.velocity) + " m/s, " + s.velocity_of
                  : ""));
        line("head", output.where_head());
      }
    else
      line("fluid",
           !choice.rows().empty() && choice.rows().front().term.is_asked
             ? "left out (Model = auto): no mesh, no matrices"
             : "left out (Fluid/Model = none): no mesh, no matrices");
    lines("boundaries", boundaries(m));
    lines("walls", other_walls(m));
    line("contacts",
         m.grains_move ? std::to_string(m.contacts.walls().size()) + " walls; " + m.contacts.partitioning(m.grains.n())
                       : "left out: all grains are fixed");
    lines("model", choice.in_words());
    line("observers", output.observers());
    line("costs",
         rounded(s.n_steps) + " steps; roughly " + rounded(s.memory / 1e9) + " GB of memory and " +
           duration_in_words(s.time) + " on an idle machine, if grains move all the time");
    out << std::flush;
    return s.time;
  }
} // namespace alluvium::run
