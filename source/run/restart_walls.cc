#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/run/restart_walls.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  namespace
  {
    using Walls = std::vector<grains::WallSegment>;

    constexpr std::size_t none = static_cast<std::size_t>(-1);

    /** For each of @p now the number of the one of @p before that stood in its place, or none; by names first. */
    std::vector<std::size_t> find_same(const Walls &before, const Walls &now)
    {
      std::vector<std::size_t> same(now.size(), none);
      std::vector<bool>        taken(before.size(), false);
      for (const bool by_name : {true, false})
        for (std::size_t k = 0; k < now.size(); ++k)
          for (std::size_t m = 0; m < before.size() && same[k] == none; ++m)
            if (!taken[m] && before[m].a == now[k].a && before[m].b == now[k].b &&
                (!by_name || before[m].name == now[k].name))
              {
                same[k]  = m;
                taken[m] = true;
              }
      return same;
    }

    /** @p wall where its motion has brought it by @p time [s]. */
    grains::WallSegment moved_on(const grains::WallSegment &wall, const double time, const double time_step)
    {
      constexpr double       most_steps = 1e5; // more would show in nothing but the set-up's time
      const double           n          = std::clamp(std::ceil(time / time_step), 1., most_steps);
      contacts::WallGeometry geometry;
      geometry.set({wall});
      geometry.set_time(0.);
      if (grains::ever_acts(wall))
        for (double step = 0.; step < n; step += 1.)
          {
            geometry.begin_substep(time / n);
            geometry.move(time / n);
          }
      grains::WallSegment result = wall;
      const auto         &there  = geometry.segments().front();
      result.a                   = there.a;
      result.b                   = there.b;
      result.centre              = there.centre;
      if (wall.motion)
        result.present = wall.motion->is_present(time);
      return result;
    }

    /** The point of a wall, then at @p then, that was at @p p when the wall was @p first. */
    std::array<double, 2>
    carried(const std::array<double, 2> &p, const grains::WallSegment &first, const grains::WallSegment &then)
    {
      const double ex = first.b[0] - first.a[0], ey = first.b[1] - first.a[1], e2 = ex * ex + ey * ey;
      const double fx = then.b[0] - then.a[0], fy = then.b[1] - then.a[1];
      const double c = e2 > 0. ? (ex * fx + ey * fy) / e2 : 1., s = e2 > 0. ? (ex * fy - ey * fx) / e2 : 0.;
      const double x = p[0] - first.a[0], y = p[1] - first.a[1];
      return {{then.a[0] + c * x - s * y, then.a[1] + s * x + c * y}};
    }
  } // namespace


  void fit_to_walls(
    contacts::ContactArchive &archive, const Walls &before, const Walls &now, const double time, const double time_step)
  {
    contacts::WallGeometry left;
    left.set(before);
    left.place(archive.wall_positions);
    const std::vector<std::size_t> same = find_same(before, now);

    Walls placed  = now;
    bool  differs = false; // from where they are without an archive
    for (std::size_t k = 0; k < now.size(); ++k)
      {
        grains::WallSegment &wall = placed[k];
        if (same[k] == none)
          wall = moved_on(now[k], time, time_step);
        else
          {
            const grains::WallSegment &first = before[same[k]], &then = left.segments()[same[k]];
            wall.a       = then.a;
            wall.b       = then.b;
            wall.centre  = first.centre == now[k].centre ? then.centre : carried(now[k].centre, first, then);
            wall.present = now[k].motion == nullptr || then.present;
          }
        differs = differs || grains::ever_acts(now[k]) || wall.a != now[k].a || wall.b != now[k].b;
      }
    archive.wall_positions = differs ? contacts::WallGeometry::positions_of(placed) : std::vector<double>();

    std::vector<contacts::ContactArchive::Entry> kept;
    for (auto entry : archive.entries)
      {
        if (entry.wall)
          {
            const auto k = std::find(same.begin(), same.end(), static_cast<std::size_t>(grains::GrainId(~entry.b)));
            if (k == same.end())
              continue;
            entry.b = ~static_cast<grains::GrainId>(k - same.begin());
          }
        kept.push_back(entry);
      }
    archive.entries = std::move(kept);
  }


  void check_room_at_walls(const contacts::ContactArchive &archive,
                           const Walls                    &walls,
                           const grains::GrainArrays      &grains,
                           const grains::Periodicity      &periodicity)
  {
    contacts::WallGeometry geometry;
    geometry.set(walls);
    geometry.place(archive.wall_positions);
    Walls there;
    for (const auto &wall : geometry.segments())
      if (wall.present)
        there.push_back(wall);
    if (grains.n() == 0)
      return;
    const double smallest = 2. * *std::min_element(grains.radius.begin(), grains.radius.end());
    for (const auto &overlap : contacts::find_overlaps(grains, there, 0.1 * smallest, periodicity))
      {
        const auto   found    = std::find(grains.id.begin(), grains.id.end(), overlap.a);
        const double diameter = 2. * grains.radius[found - grains.id.begin()];
        check_user(
          overlap.wall.empty() || overlap.depth <= 0.1 * diameter,
          "Output/Restart: Grains/Extra walls, Motion of walls or Presence of walls have changed, and the wall '" +
            overlap.wall + "' now stands in grain " + std::to_string(overlap.a) + " of the checkpoint, by " +
            in_digits(overlap.depth / diameter) + " of its diameter. Put it where there is room.");
      }
  }
} // namespace alluvium::run
