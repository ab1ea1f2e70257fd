#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/run/divergence_monitor.h>
#include <alluvium/run/model.h>
#include <alluvium/run/places.h>

#include <deal.II/base/parameter_handler.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    const std::string smaller_step = "Try a smaller Time/Time step";
    const std::string more_room    = "Something presses grains into a place that is too small for them, or they are "
                                     "too fast for the time step. " +
                                  smaller_step + ", tighter tolerances in Contacts, slower walls, or more room.";

    /** Number of grain @p id in the arrays: some may have left. */
    std::size_t number_of(const Model &m, const grains::GrainId id)
    {
      return std::lower_bound(m.grains.id.begin(), m.grains.id.end(), id) - m.grains.id.begin();
    }
  } // namespace


  void DivergenceMonitor::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Divergence");
    prm.add_parameter("Stop",
                      stop,
                      "End the run (exit code 3) when a step shows that the computation has run away; otherwise warn. "
                      "What is not a number ends it always.");
    prm.add_parameter("Largest penetration",
                      largest_penetration,
                      "Overlap of two grains, or of a grain and a wall, above which contacts have failed [diameters of "
                      "the smaller grain]. Above a fifth of it there is a warning, once.",
                      Patterns::Double(0.));
    prm.leave_subsection();
  }


  /**
   * Energy that is not worth a word: of everything, moving at a tenth of the speed that contacts are measured in,
   * sqrt(g d), or d/100 a time step without gravity, up to which they push overlaps open [J/m].
   */
  double DivergenceMonitor::noise(const Model &m) const
  {
    const double d    = m.grains.n() > 0 ? grains::mean_diameter(m.grains) : m.initial_diameter;
    const double unit = m.gravity_size() > 0. ? m.gravity_size() * d : std::pow(0.01 * d / longest_step, 2);
    double       mass = 0.;
    for (const double x : m.grains.mass)
      mass += std::isinf(x) ? 0. : x;
    if (m.has_fluid)
      mass += m.solver.properties.density * (m.domain.upper()[0] - m.domain.lower()[0]) *
              (m.domain.upper()[1] - m.domain.lower()[1]);
    return 0.5 * mass * 0.01 * unit;
  }


  /**
   * The kinetic energy with that of springs, or what is left of a larger one before it [J/m]. A grain that bounces has
   * next to none at its highest point, but the error of the time of its impact is a part of what it had there. The
   * memory fades over some free flights, 2 v / g, of the fastest grain; without gravity nothing stores it.
   */
  double DivergenceMonitor::kinetic_of_late(const Model &m, const StepMeasures &s)
  {
    of_late = flight > 0. ? of_late * std::exp(-m.time_step / (4. * flight)) : 0.;
    if (s.energy.kinetic + s.energy.springs >= of_late)
      {
        of_late = s.energy.kinetic + s.energy.springs;
        flight  = m.gravity_size() > 0. ? 2. * s.grain_velocity / m.gravity_size() : 0.;
      }
    return of_late;
  }


  Sign DivergenceMonitor::judge_energy(const Model &m, const StepMeasures &s)
  {
    longest_step       = std::max(longest_step, m.time_step); // the last one may be short
    unexplained        = std::max(0., unexplained + s.energy.remainder);
    smallest_bound     = std::max(smallest_bound, noise(m)); // grains may leave, what they have left behind stays
    const double bound = 0.5 * kinetic_of_late(m, s) + smallest_bound;
    calm               = unexplained <= 0.5 * bound;
    if (bound > 0.)
      largest_share_of_bound = std::max(largest_share_of_bound, unexplained / bound);
    if (unexplained <= bound)
      return {};
    const bool         fluid = m.has_fluid && s.fluid_velocity > s.grain_velocity;
    const Place        place = fluid ? fastest_fluid(m) : fastest_grain(m);
    std::ostringstream what;
    what << (fluid ? "the fluid" : "a grain") << " has reached " << (fluid ? s.fluid_velocity : s.grain_velocity)
         << " m/s: energy that no pressure, inflow, wall or weight has supplied is";
    return {what.str(),
            unexplained,
            bound,
            "J/m",
            place.point,
            place.name,
            smaller_step + (m.has_fluid
                              ? ", another Coupling/Time scheme (explicit ones have a limit), or finer cells where the "
                                "flow leaves through an open boundary."
                              : " or other contact parameters.")};
  }


  Sign DivergenceMonitor::judge_penetration(const Model &m, const double bound) const
  {
    // cheap first: the largest overlap of all against the smallest grain
    if (!m.grains_move || m.grains.n() == 0)
      return {};
    const double smallest = 2. * *std::min_element(m.grains.radius.begin(), m.grains.radius.end());
    if (m.contact_report.max_penetration <= bound * smallest)
      return {};
    for (const auto &o :
         contacts::find_overlaps(m.grains, m.contacts.walls(), bound * smallest, m.domain.periodicity()))
      {
        const std::size_t a = number_of(m, o.a);
        const double      radius =
          o.wall.empty() ? std::min(m.grains.radius[a], m.grains.radius[number_of(m, o.b)]) : m.grains.radius[a];
        const double share = o.depth / (2. * radius);
        if (share <= bound)
          continue;
        const std::string partner = o.wall.empty() ? "grain " + std::to_string(o.b) : "the wall '" + o.wall + "'";
        return {"grain " + std::to_string(o.a) + " and " + partner + " overlap by",
                share,
                bound,
                "diameters",
                {{m.grains.position[0][a], m.grains.position[1][a]}},
                "grain " + std::to_string(o.a),
                more_room};
      }
    return {};
  }


  std::string DivergenceMonitor::doubt_overlap(const Model &m)
  {
    constexpr double part = 0.2; // of what ends the run
    if (overlap_was_doubted)
      return {};
    const Sign sign = judge_penetration(m, part * largest_penetration);
    if (sign.what.empty())
      return {};
    overlap_was_doubted = true;
    std::ostringstream text;
    text << sign.what << ' ' << sign.value
         << " diameters of the smaller one: contacts are soft, or were not solved well. "
         << (m.contacts.is_soft() ? "Try a larger Contacts/Soft spheres/Stiffness."
                                  : smaller_step + ", or tighter tolerances in Contacts.");
    return text.str();
  }


  Sign DivergenceMonitor::judge_contacts(const Model &m) const
  {
    const contacts::Crush &crush = m.contact_report.crush;
    if (!m.grains_move || !(crush.depth > largest_penetration))
      return {};
    const std::size_t a    = number_of(m, crush.a);
    const std::string name = "grain " + std::to_string(crush.a), partner = crush.wall.empty()
                                                                             ? "grain " + std::to_string(crush.b)
                                                                             : "the wall '" + crush.wall + "'";
    return {crush.passed ? name + " has been pressed through " + partner + ", by"
                         : name + " and " + partner + " overlap by",
            crush.depth,
            largest_penetration,
            "diameters",
            {{m.grains.position[0][a], m.grains.position[1][a]}},
            name,
            more_room};
  }


  void DivergenceMonitor::save(nlohmann::ordered_json &state) const
  {
    state["divergence monitor"] = {
      unexplained, largest_share_of_bound, smallest_bound, of_late, flight, overlap_was_doubted};
  }


  void DivergenceMonitor::load(const nlohmann::ordered_json &state)
  {
    if (!state.contains("divergence monitor"))
      return;
    unexplained            = state.at("divergence monitor").at(0).get<double>();
    largest_share_of_bound = state.at("divergence monitor").at(1).get<double>();
    smallest_bound         = state.at("divergence monitor").at(2).get<double>();
    if (state.at("divergence monitor").size() > 3)
      {
        of_late = state.at("divergence monitor").at(3).get<double>();
        flight  = state.at("divergence monitor").at(4).get<double>();
      }
    if (state.at("divergence monitor").size() > 5)
      overlap_was_doubted = state.at("divergence monitor").at(5).get<bool>();
  }


  Sign DivergenceMonitor::judge(const Model &m, const StepMeasures &s)
  {
    calm = false;
    if (!s.finite || !std::isfinite(s.energy.kinetic))
      {
        const bool  fluid = !s.finite;
        const Place place = fluid ? fastest_fluid(m) : fastest_grain(m);
        return {fluid ? "a field of the fluid is not a number" : "a grain's velocity is not a number",
                std::nan(""),
                0.,
                "",
                place.point,
                place.name,
                smaller_step + "."};
      }
    Sign energy = judge_energy(m, s);
    if (Sign sign = judge_penetration(m, largest_penetration); !sign.what.empty())
      {
        calm = false;
        return sign;
      }
    constexpr double largest_loss = 0.01;
    if (std::abs(s.solid_lost) > largest_loss)
      {
        calm = false;
        return {"the void fraction would have to be below 0: volume of the grains that finds no room in the cells is",
                s.solid_lost,
                largest_loss,
                "of all",
                {},
                "",
                "Grains lie on top of one another; see Coupling/Filter radius and Contacts. " + smaller_step + "."};
      }
    return energy;
  }


  std::string in_words(const Sign &sign, const unsigned int step, const double time)
  {
    std::ostringstream text;
    text << "The run has diverged in step " << step << ", t = " << time << " s: " << sign.what;
    if (std::isfinite(sign.value))
      text << ' ' << sign.value << ' ' << sign.unit << " (bound " << sign.bound << ")";
    if (!sign.near.empty())
      text << ", at (" << sign.point[0] << ", " << sign.point[1] << ") m, near " << sign.near;
    text << ". " << sign.advice;
    return text.str();
  }
} // namespace alluvium::run
