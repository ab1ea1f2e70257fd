#include <alluvium/run/check_walls.h>
#include <alluvium/run/model.h>
#include <alluvium/utilities/digits.h>

#include <algorithm>
#include <string>

namespace alluvium::run
{
  namespace
  {
    /** A list of names in quotes, each once. */
    struct QuotedNames
    {
      std::string text;

      bool contains(const std::string &name) const { return text.find("'" + name + "'") != std::string::npos; }

      void add(const std::string &name)
      {
        if (!contains(name))
          text += (text.empty() ? "'" : ", '") + name + "'";
      }
    };


    /** Names of extra walls that grains lie on: at most a tenth of a radius above them, along gravity. */
    std::string floors_inside(const Model &m)
    {
      QuotedNames  names;
      const double g = m.gravity_size();
      for (const auto &wall : m.contacts.walls())
        {
          if (!(g > 0.) || m.domain.boundary_ids().count(wall.name) > 0 || grains::ever_acts(wall) ||
              names.contains(wall.name))
            continue;
          const double x0 = std::min(wall.a[0], wall.b[0]), x1 = std::max(wall.a[0], wall.b[0]),
                       y0 = std::min(wall.a[1], wall.b[1]), y1 = std::max(wall.a[1], wall.b[1]);
          for (std::size_t k = 0; k < m.grains.n(); ++k)
            {
              const double r = m.grains.radius[k], x = m.grains.position[0][k], y = m.grains.position[1][k];
              if (x < x0 - 2. * r || x > x1 + 2. * r || y < y0 - 2. * r || y > y1 + 2. * r ||
                  grains::distance_to(wall, x, y) > 1.1 * r)
                continue;
              const double t    = grains::project(wall, x, y);
              const double down = (wall.a[0] + t * (wall.b[0] - wall.a[0]) - x) * m.gravity[0] +
                                  (wall.a[1] + t * (wall.b[1] - wall.a[1]) - y) * m.gravity[1];
              if (down < 0.5 * g * r)
                continue;
              names.add(wall.name);
              break;
            }
        }
      return names.text;
    }
  } // namespace


  void check_walls(Model &m, const double end_time)
  {
    QuotedNames late;
    for (const auto &wall : m.contacts.walls())
      if (wall.motion && std::any_of(wall.motion->phases.begin(), wall.motion->phases.end(), [&](const auto &phase) {
            return phase.from >= end_time || phase.to <= 0.;
          }))
        late.add(wall.name);
    if (!late.text.empty())
      m.warnings.add("Grains/Motion of walls: " + late.text + " is to move at times that this run, from 0 to " +
                       in_digits(end_time) + " s, does not have",
                     m.time);

    QuotedNames acting, sides;
    for (const auto &wall : m.contacts.walls())
      if (grains::ever_acts(wall))
        (m.domain.boundary_ids().count(wall.name) > 0 ? sides : acting).add(wall.name);
    const std::string resting = m.has_fluid && m.grains_move ? floors_inside(m) : "";
    const auto        warn    = [&](const std::string &text) { m.warnings.add(text, m.time); };
    if (!m.grains_move && !(acting.text.empty() && sides.text.empty()))
      warn("Grains/Fixed = true: walls stay where they are, too; their motion is ignored");
    else if (m.has_fluid)
      {
        if (!acting.text.empty())
          warn("the fluid does not see the walls " + acting.text +
               ": it flows through them, and their motion moves grains only");
        if (!sides.text.empty())
          warn("the fluid does not see the sides " + sides.text +
               " move: its domain and its boundary conditions stay as they are, only grains are moved");
        if (!resting.empty())
          warn(
            "grains lie on " + resting +
            " inside the fluid, which passes it without resistance: the flow below goes to where the bed is loosest, "
            "as above a distributor without pressure drop, so that parts of a fluidised bed stay on it and an onset by "
            "force balance may not come. For an even inflow, let the bed lie on a side of the domain with a given "
            "Velocity");
      }
  }
} // namespace alluvium::run
