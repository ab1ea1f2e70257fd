#include <alluvium/grains/bed_faces.h>
#include <alluvium/run/bed_flow.h>
#include <alluvium/run/model.h>

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <limits>
#include <map>

namespace alluvium::run
{
  BedFlow flow_across_bed(const Model &m)
  {
    const auto &columns = m.initial_bed.columns;
    const auto  up      = m.upright();
    BedFlow     result;
    if (!m.has_fluid || columns.empty() || m.gravity[up.vertical] == 0. || m.gravity[1 - up.vertical] != 0.)
      return result;
    const double left = m.domain.lower()[1 - up.vertical], right = m.domain.upper()[1 - up.vertical],
                 tiny = 1e-6 * (right - left);
    if (columns.front().left > left + tiny || columns.back().right < right - tiny)
      return result;
    for (std::size_t c = 1; c < columns.size(); ++c)
      if (columns[c].left > columns[c - 1].right + tiny)
        return result;

    std::map<std::string, std::array<double, 2>> heights; // of each side, lowest and highest point
    for (const auto &side : m.domain.sides())
      {
        auto &[low, high] = heights
                              .try_emplace(side.name,
                                           std::array<double, 2>{{std::numeric_limits<double>::max(),
                                                                  std::numeric_limits<double>::lowest()}})
                              .first->second;
        low  = std::min({low, up.to(side.a)[1], up.to(side.b)[1]});
        high = std::max({high, up.to(side.a)[1], up.to(side.b)[1]});
      }
    const double reach = grains::mean_diameter(m.grains); // the rule of a quarter of a layer leaves some grains outside
    unsigned int n_below = 0, n_above = 0, n_beside = 0;
    for (const auto &[id, condition] : m.boundary_conditions.all())
      {
        const auto side = heights.find(condition.name);
        if (!condition.kind->lets_fluid_pass() || side == heights.end())
          continue;
        const auto [low, high] = side->second;
        if (high <= m.initial_bed.bottom() + reach)
          ++n_below;
        else if (low >= m.initial_bed.top() - reach)
          ++n_above;
        else
          ++n_beside;
      }
    result.crosses  = n_beside == 0 && n_below > 0 && n_above > 0;
    result.has_head = result.crosses || n_below + n_above + n_beside <= 1;
    return result;
  }
} // namespace alluvium::run
