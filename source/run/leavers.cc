#include <alluvium/grains/grain_columns.h>
#include <alluvium/run/leavers.h>
#include <alluvium/run/model.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <sstream>

namespace alluvium::run
{
  namespace
  {
    std::vector<std::string> sides_left_through(const Model &m)
    {
      std::vector<std::string> result(m.grains.n());
      if (!m.domain.open_to_grains_names().empty())
        for (std::size_t i = 0; i < m.grains.n(); ++i)
          result[i] = m.domain.left_through({{m.grains.position[0][i], m.grains.position[1][i]}});
      return result;
    }
  } // namespace


  void count_leavers(Model &m)
  {
    const auto open = m.domain.open_to_grains_names();
    for (const auto &name : open)
      m.leavers.by_side[name];
    const auto  sides = sides_left_through(m);
    const auto &g     = m.grains;
    for (std::size_t i = 0; i < g.n(); ++i)
      if (!sides[i].empty())
        {
          if (std::find(open.begin(), open.end(), sides[i]) == open.end())
            {
              std::ostringstream text;
              text << "Grain " << g.id[i] << " has gone through the wall '" << sides[i] << "': it is at ("
                   << g.position[0][i] << ", " << g.position[1][i] << ") m. Try a smaller Time/Time step.";
              throw UserError(text.str());
            }
          grains::Departure &d = m.leavers.by_side[sides[i]];
          d.n += 1;
          d.mass += g.mass[i];
          d.momentum[0] += g.mass[i] * g.velocity[0][i];
          d.momentum[1] += g.mass[i] * g.velocity[1][i];
        }
  }


  bool remove_leavers(Model &m)
  {
    const auto                sides = sides_left_through(m);
    std::vector<std::uint8_t> keep(sides.size());
    std::transform(sides.begin(), sides.end(), keep.begin(), [](const auto &name) { return name.empty(); });
    if (std::all_of(keep.begin(), keep.end(), [](const auto k) { return k != 0; }))
      return false;
    auto &g = m.grains;
    grains::keep_some(g.id, keep);
    grains::for_each_column(g, [&](auto &values, const grains::GrainColumn &) { grains::keep_some(values, keep); });
    grains::keep_some(m.touched, keep);
    m.loads.reset(g.n());
    m.contacts.set_archive(m.contacts.archive()); // to be searched anew
    if (m.has_fluid)
      m.coupling.remove_grains(keep);
    return true;
  }
} // namespace alluvium::run
