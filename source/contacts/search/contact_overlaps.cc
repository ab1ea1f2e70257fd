#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::contacts
{
  std::vector<Overlap> find_overlaps(const grains::GrainArrays              &grains,
                                     const std::vector<grains::WallSegment> &walls,
                                     const double                            tolerance,
                                     const grains::Periodicity              &periodicity)
  {
    ContactGeometry geometry;
    geometry.walls.set(walls);
    geometry.periodicity               = periodicity;
    const ContactCandidates candidates = find_candidates(grains, geometry, 0.);
    std::vector<Overlap>    overlaps;
    for (const ContactPair &p : candidates.discs)
      {
        double dx = grains.position[0][p.j] - grains.position[0][p.i],
               dy = grains.position[1][p.j] - grains.position[1][p.i];
        periodicity.shorten(dx, dy);
        const double depth = grains.radius[p.i] + grains.radius[p.j] - std::hypot(dx, dy);
        if (depth > tolerance)
          overlaps.push_back({grains.id[p.i], grains.id[p.j], "", depth});
      }
    for (const ContactPair &p : candidates.walls)
      {
        ContactPoint point;
        if (geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point) &&
            -point.gap > tolerance)
          overlaps.push_back({grains.id[p.i], 0, walls[p.j].name.empty() ? "wall" : walls[p.j].name, -point.gap});
      }
    std::stable_sort(
      overlaps.begin(), overlaps.end(), [](const Overlap &p, const Overlap &q) { return p.depth > q.depth; });
    return overlaps;
  }

  void check_overlaps(const grains::GrainArrays              &grains,
                      const std::vector<grains::WallSegment> &walls,
                      const double                            tolerance,
                      const grains::Periodicity              &periodicity)
  {
    const std::vector<Overlap> overlaps = find_overlaps(grains, walls, tolerance, periodicity);
    if (overlaps.empty())
      return;
    const Overlap &worst     = overlaps.front();
    const auto     number_of = [&](const grains::GrainId id) {
      return static_cast<std::size_t>(std::lower_bound(grains.id.begin(), grains.id.end(), id) - grains.id.begin());
    };
    // the smaller one, which is the likelier mistake
    std::size_t k = number_of(worst.a), other = k;
    if (worst.wall.empty())
      {
        other = number_of(worst.b);
        if (grains.radius[other] < grains.radius[k])
          std::swap(k, other);
      }
    std::ostringstream text;
    text << "Grain " << grains.id[k] << " at (" << grains.position[0][k] << ", " << grains.position[1][k]
         << ") m, of diameter " << 2. * grains.radius[k] << " m, overlaps "
         << (worst.wall.empty() ? "grain " + std::to_string(grains.id[other]) : "the wall '" + worst.wall + "'")
         << " by " << worst.depth << " m, " << worst.depth / (2. * grains.radius[k]) << " of its diameter; "
         << overlaps.size() << " pairs overlap by more than " << tolerance << " m. Move the grains apart.";
    throw UserError(text.str());
  }
} // namespace alluvium::contacts
