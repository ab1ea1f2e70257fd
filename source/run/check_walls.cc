#include <alluvium/run/check_walls.h>
#include <alluvium/run/model.h>

#include <string>

namespace alluvium::run
{
  void check_walls(Model &m)
  {
    std::string acting, sides;
    for (const auto &wall : m.contacts.walls())
      if (grains::ever_acts(wall))
        {
          std::string &list = m.domain.boundary_ids().count(wall.name) > 0 ? sides : acting;
          if (list.find("'" + wall.name + "'") == std::string::npos)
            list += (list.empty() ? "'" : ", '") + wall.name + "'";
        }
    const auto warn = [&](const std::string &text) { m.warnings.add(text, m.time); };
    if (!m.grains_move && !(acting + sides).empty())
      warn("Grains/Fixed = true: walls stay where they are, too; their motion is ignored");
    else if (m.has_fluid)
      {
        if (!acting.empty())
          warn("the fluid does not see the walls " + acting +
               ": it flows through them, and their motion moves grains only");
        if (!sides.empty())
          warn("the fluid does not see the sides " + sides +
               " move: its domain and its boundary conditions stay as they are, only grains are moved");
      }
  }
} // namespace alluvium::run
