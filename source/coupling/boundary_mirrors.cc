#include <alluvium/coupling/boundary_mirrors.h>
#include <alluvium/coupling/grain_bins.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace alluvium::coupling
{
  using namespace dealii;

  namespace
  {
    using Point2 = std::array<double, 2>;

    constexpr unsigned int no_mirror = static_cast<unsigned int>(-1);
    constexpr unsigned int at_most   = 3; // mirrors one after the other: corners down to 60 degrees
    constexpr double       close     = 1e-9;

    /** Twice the area of the triangle a, b, p: above zero to the left of a to b. */
    double left_of(const Point2 &a, const Point2 &b, const Point2 &p)
    {
      return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    }

    double distance(const Point2 &a, const Point2 &b, const double x, const double y)
    {
      const double ex = b[0] - a[0], ey = b[1] - a[1];
      const double s = std::clamp(((x - a[0]) * ex + (y - a[1]) * ey) / (ex * ex + ey * ey), 0., 1.);
      return std::hypot(a[0] + s * ex - x, a[1] + s * ey - y);
    }

    /**
     * Where on the way from p (0) to q (1) the side a to b is crossed from right to left; below 0: nowhere. The side
     * may be longer at both ends by @p longer of itself.
     */
    double crossing(const Point2 &p, const Point2 &q, const Point2 &a, const Point2 &b, const double longer = 0.)
    {
      const double from = left_of(a, b, p), to = left_of(a, b, q);
      if (!(from < 0. && to > 0.))
        return -1.;
      const double t = from / (from - to), ex = b[0] - a[0], ey = b[1] - a[1];
      const double s =
        ((p[0] + t * (q[0] - p[0]) - a[0]) * ex + (p[1] + t * (q[1] - p[1]) - a[1]) * ey) / (ex * ex + ey * ey);
      return s >= -longer && s <= 1. + longer ? t : -1.;
    }
  } // namespace


  BoundaryMirrors::BoundaryMirrors(const fluid::FluidSpace<2> &space)
  {
    const auto          straight = straight_sides(space);
    std::vector<double> mine;
    for (const auto &cell : space.triangulation().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const auto f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              const auto face = cell->face(f);
              Point2     a = {{face->vertex(0)[0], face->vertex(0)[1]}}, b = {{face->vertex(1)[0], face->vertex(1)[1]}};
              const double tolerance = 1e-10 * face->measure();
              bool         on_box    = false;
              for (unsigned int d = 0; d < 2; ++d)
                for (const double where : straight[d])
                  on_box = on_box || (std::abs(a[d] - where) < tolerance + 1e-10 * std::abs(where) &&
                                      std::abs(b[d] - where) < tolerance + 1e-10 * std::abs(where));
              if (on_box)
                continue;
              if (left_of(a, b, {{cell->center()[0], cell->center()[1]}}) < 0.)
                std::swap(a, b);
              mine.insert(mine.end(), {a[0], a[1], b[0], b[1]});
            }
    for (const auto &part : Utilities::MPI::all_gather(space.communicator(), mine))
      for (std::size_t k = 0; k < part.size(); k += 4)
        sides.push_back({{{part[k], part[k + 1]}}, {{part[k + 2], part[k + 3]}}});
    // where the box mirrors grains, it mirrors the walls near them
    for (unsigned int d = 0; d < 2; ++d)
      for (std::size_t k = 0, n = sides.size(); k < n; ++k)
        for (const double where : straight[d])
          {
            Side image = {sides[k].b, sides[k].a};
            image.a[d] = 2. * where - image.a[d];
            image.b[d] = 2. * where - image.b[d];
            sides.push_back(image);
          }
    const auto before = [](const Side &p, const Side &q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); };
    std::sort(sides.begin(), sides.end(), before); // whichever rank had them
    join();
  }


  /** Make one of the sides that continue each other straight on: fine cells have many, with the same images. */
  void BoundaryMirrors::join()
  {
    std::multimap<Point2, std::size_t> ends, starts;
    for (std::size_t k = 0; k < sides.size(); ++k)
      {
        starts.insert({sides[k].a, k});
        ends.insert({sides[k].b, k});
      }
    const auto straight_on = [](const Side &p, const Side &q) {
      const double px = p.b[0] - p.a[0], py = p.b[1] - p.a[1], qx = q.b[0] - q.a[0], qy = q.b[1] - q.a[1];
      return px * qx + py * qy > 0. && std::abs(px * qy - py * qx) < 1e-9 * (px * qx + py * qy);
    };
    constexpr std::size_t    none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> next(sides.size(), none);
    std::vector<bool>        continues(sides.size(), false);
    for (std::size_t k = 0; k < sides.size(); ++k)
      for (auto [q, last] = starts.equal_range(sides[k].b); q != last; ++q)
        if (!continues[q->second] && straight_on(sides[k], sides[q->second]))
          {
            next[k]              = q->second;
            continues[q->second] = true;
            break;
          }
    std::vector<Side> joined;
    for (std::size_t k = 0; k < sides.size(); ++k)
      if (!continues[k])
        {
          joined.push_back(sides[k]);
          for (std::size_t q = next[k]; q != none; q = next[q])
            joined.back().b = sides[q].b;
        }
    sides = std::move(joined);
  }


  void BoundaryMirrors::add_images(GrainImages &images, const double reach)
  {
    mirror.assign(images.n(), no_mirror);
    parent.assign(images.n(), no_mirror);
    begin.assign(1, 0);
    near.clear();
    if (sides.empty() || images.n() == 0)
      return;

    // pairs (image, side) within reach
    std::vector<unsigned int> found;
    const auto                find_near = [&](const GrainBins &bins, const Side &side) {
      Point2 low, high;
      for (unsigned int d = 0; d < 2; ++d)
        {
          low[d]  = std::min(side.a[d], side.b[d]) - reach;
          high[d] = std::max(side.a[d], side.b[d]) + reach;
        }
      bins.find(low, high, found);
      found.erase(std::remove_if(
                    found.begin(),
                    found.end(),
                    [&](const unsigned int k) { return distance(side.a, side.b, images.x[k], images.y[k]) >= reach; }),
                  found.end());
    };

    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    unsigned int                                       first = 0; // of the images that have not been mirrored yet
    for (unsigned int n_mirrors = 1; n_mirrors <= at_most && first < images.n(); ++n_mirrors)
      {
        pairs.clear();
        const GrainBins bins(images.x, images.y, reach);
        for (unsigned int m = 0; m < sides.size(); ++m)
          {
            find_near(bins, sides[m]);
            for (const unsigned int k : found)
              if (const Point2 centre = {{images.x[k], images.y[k]}};
                  k >= first && left_of(sides[m].a, sides[m].b, centre) > 0. &&
                  (mirror[k] == no_mirror || (mirror[k] != m && is_lit(centre, sides[mirror[k]], sides[m], reach))))
                pairs.push_back({k, m});
          }
        first = images.n();
        std::sort(pairs.begin(), pairs.end());
        for (const auto &[k, m] : pairs)
          {
            const double ex = sides[m].b[0] - sides[m].a[0], ey = sides[m].b[1] - sides[m].a[1];
            const double height = left_of(sides[m].a, sides[m].b, {{images.x[k], images.y[k]}}) /
                                  (ex * ex + ey * ey); // over the side's length
            images.add(k, {{2. * height * ey, -2. * height * ex}});
            mirror.push_back(m);
            parent.push_back(k);
          }
      }

    pairs.clear();
    const GrainBins bins(images.x, images.y, reach);
    for (unsigned int m = 0; m < sides.size(); ++m)
      {
        find_near(bins, sides[m]);
        for (const unsigned int k : found)
          pairs.push_back({k, m});
      }
    std::sort(pairs.begin(), pairs.end());
    begin.assign(images.n() + 1, 0);
    for (const auto &[k, m] : pairs)
      {
        ++begin[k + 1];
        near.push_back(m);
      }
    for (std::size_t k = 0; k < images.n(); ++k)
      begin[k + 1] += begin[k];
  }


  /** Does any light from @p centre through @p window fall on @p side within @p reach? */
  bool BoundaryMirrors::is_lit(const std::array<double, 2> &centre,
                               const Side                  &window,
                               const Side                  &side,
                               const double                 reach) const
  {
    double     first = 0., last = 1.;
    const auto cut = [&](const double at_a, const double at_b) { // what is above zero
      if (at_a <= 0. && at_b <= 0.)
        last = -1.;
      else if (at_a < 0.)
        first = std::max(first, at_a / (at_a - at_b));
      else if (at_b < 0.)
        last = std::min(last, at_a / (at_a - at_b));
    };
    cut(left_of(window.a, window.b, side.a), left_of(window.a, window.b, side.b));
    cut(left_of(centre, window.b, side.a), left_of(centre, window.b, side.b));
    cut(left_of(window.a, centre, side.a), left_of(window.a, centre, side.b));
    if (!(first < last))
      return false;
    const auto at = [&](const double t) {
      return Point2{{side.a[0] + t * (side.b[0] - side.a[0]), side.a[1] + t * (side.b[1] - side.a[1])}};
    };
    return distance(at(first), at(last), centre[0], centre[1]) < reach;
  }


  bool BoundaryMirrors::sees(const GrainImages &images, const std::size_t k, const std::array<double, 2> &point) const
  {
    return sides.empty() || sees(images, k, point, 1.);
  }


  /** As far as the part @p last of the way. */
  bool BoundaryMirrors::sees(const GrainImages           &images,
                             const std::size_t            k,
                             const std::array<double, 2> &point,
                             const double                 last) const
  {
    const Point2 centre   = {{images.x[k], images.y[k]}};
    double       entrance = 0.;
    if (mirror[k] != no_mirror)
      {
        // what comes out of a corner itself, which two orders of the same mirrors share, is the first one's
        const bool   twice  = mirror[parent[k]] != no_mirror;
        const Side  &own    = sides[mirror[k]];
        const double longer = last < 1. ? close : !twice ? 0. : mirror[parent[k]] < mirror[k] ? close : -close;
        entrance            = crossing(centre, point, own.a, own.b, longer);
        if (entrance < 0.)
          return false;
        if (twice)
          {
            // seen in the first mirror as far as this one, and a little farther: in a corner it is crossed there, too
            const std::size_t up = parent[k];
            Point2            there;
            for (unsigned int d = 0; d < 2; ++d)
              {
                const double from = d == 0 ? images.x[up] : images.y[up];
                there[d]          = from + (1. + 2. * close) * (centre[d] + entrance * (point[d] - centre[d]) - from);
              }
            if (!sees(images, up, there, 1. - 3. * close))
              return false;
          }
      }
    // outwards, and not through the other face of the crack that is the mirror
    for (unsigned int s = begin[k]; s < begin[k + 1]; ++s)
      if (const double t = crossing(centre, point, sides[near[s]].b, sides[near[s]].a);
          t > entrance + close && t < last)
        return false;
    return true;
  }
} // namespace alluvium::coupling
