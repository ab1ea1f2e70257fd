#include <alluvium/grains/contact_search.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace alluvium::grains
{
  namespace
  {
    /** Parameter of the point of segment @p w nearest to (x, y): 0 at a, 1 at b. */
    double project(const WallSegment &w, const double x, const double y)
    {
      const double ex = w.b[0] - w.a[0], ey = w.b[1] - w.a[1], e2 = ex * ex + ey * ey;
      if (e2 == 0.)
        return 0.;
      return std::clamp(((x - w.a[0]) * ex + (y - w.a[1]) * ey) / e2, 0., 1.);
    }

    bool same_point(const std::array<double, 2> &p, const std::array<double, 2> &q, const double tolerance)
    {
      return std::abs(p[0] - q[0]) <= tolerance && std::abs(p[1] - q[1]) <= tolerance;
    }

    double distance_to(const WallSegment &w, const double x, const double y)
    {
      const double t = project(w, x, y);
      return std::hypot(w.a[0] + t * (w.b[0] - w.a[0]) - x, w.a[1] + t * (w.b[1] - w.a[1]) - y);
    }

    /** Grains sorted into the cells of a grid over their bounding box. */
    struct CellGrid
    {
      double                     x0, y0, width;
      int                        nx, ny;
      std::vector<std::uint32_t> begin, member; // grains of cell c: member[begin[c]] ... member[begin[c + 1] - 1]

      int column(const double x) const { return std::clamp(static_cast<int>(std::floor((x - x0) / width)), 0, nx - 1); }
      int row(const double y) const { return std::clamp(static_cast<int>(std::floor((y - y0) / width)), 0, ny - 1); }

      CellGrid(const GrainArrays &g, const double smallest_width)
        : width(smallest_width)
      {
        const auto [x_min, x_max] = std::minmax_element(g.x.begin(), g.x.end());
        const auto [y_min, y_max] = std::minmax_element(g.y.begin(), g.y.end());
        x0                        = *x_min;
        y0                        = *y_min;
        const double lx = *x_max - x0, ly = *y_max - y0;
        // One grain that flew far away must not cost the memory of all the cells in between.
        while ((lx / width + 1.) * (ly / width + 1.) > 1024. + 8. * g.n())
          width *= 1.5;
        nx = static_cast<int>(lx / width) + 1;
        ny = static_cast<int>(ly / width) + 1;

        std::vector<std::uint32_t> cell(g.n());
        begin.assign(static_cast<std::size_t>(nx) * ny + 1, 0);
        for (std::size_t k = 0; k < g.n(); ++k)
          {
            cell[k] = row(g.y[k]) * nx + column(g.x[k]);
            ++begin[cell[k] + 1];
          }
        for (std::size_t c = 1; c < begin.size(); ++c)
          begin[c] += begin[c - 1];
        member.resize(g.n());
        std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
        for (std::size_t k = 0; k < g.n(); ++k)
          member[end[cell[k]]++] = k;
      }
    };

    /** Sort by (i, j): a counting sort over i, then short runs by j. */
    void sort_pairs(std::vector<ContactPair> &pairs, const std::size_t n)
    {
      std::vector<std::uint32_t> begin(n + 1, 0);
      for (const ContactPair &p : pairs)
        ++begin[p.i + 1];
      for (std::size_t k = 0; k < n; ++k)
        begin[k + 1] += begin[k];
      std::vector<ContactPair>   sorted(pairs.size());
      std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
      for (const ContactPair &p : pairs)
        sorted[end[p.i]++] = p;
      for (std::size_t k = 0; k < n; ++k)
        std::sort(sorted.begin() + begin[k],
                  sorted.begin() + begin[k + 1],
                  [](const ContactPair &p, const ContactPair &q) { return p.j < q.j; });
      pairs.swap(sorted);
    }
  } // namespace

  void WallGeometry::set(std::vector<WallSegment> segments)
  {
    walls  = std::move(segments);
    moving = std::any_of(
      walls.begin(), walls.end(), [](const WallSegment &w) { return w.velocity[0] != 0. || w.velocity[1] != 0.; });
    find_shared_ends();
  }

  void WallGeometry::find_shared_ends()
  {
    sharing.assign(walls.size(), {});
    for (std::size_t k = 0; k < walls.size(); ++k)
      for (std::size_t m = 0; m < walls.size(); ++m)
        if (m != k)
          {
            const double tolerance =
              1e-9 * std::max(std::hypot(walls[k].b[0] - walls[k].a[0], walls[k].b[1] - walls[k].a[1]),
                              std::hypot(walls[m].b[0] - walls[m].a[0], walls[m].b[1] - walls[m].a[1]));
            for (int end = 0; end < 2; ++end)
              {
                const auto &p = end == 0 ? walls[k].a : walls[k].b;
                if (same_point(p, walls[m].a, tolerance) || same_point(p, walls[m].b, tolerance))
                  sharing[k][end].push_back(m);
              }
          }
  }

  void WallGeometry::move(const double dt)
  {
    if (!moving)
      return;
    bool moved = false;
    for (WallSegment &w : walls)
      {
        const double ex = w.b[0] - w.a[0], ey = w.b[1] - w.a[1], e2 = ex * ex + ey * ey;
        const double along = e2 == 0. ? 0. : (w.velocity[0] * ex + w.velocity[1] * ey) / e2;
        const double dx = dt * (w.velocity[0] - along * ex), dy = dt * (w.velocity[1] - along * ey);
        w.a[0] += dx;
        w.a[1] += dy;
        w.b[0] += dx;
        w.b[1] += dy;
        moved = moved || dx != 0. || dy != 0.;
      }
    if (moved)
      find_shared_ends();
  }

  bool
  WallGeometry::touch(const std::size_t k, const double x, const double y, const double r, ContactPoint &point) const
  {
    const WallSegment &w = walls[k];
    const double       t = project(w, x, y);
    if (t == 0. || t == 1.)
      {
        const std::array<double, 2> &corner = t == 0. ? w.a : w.b;
        for (const std::uint32_t m : sharing[k][t == 0. ? 0 : 1])
          {
            const double s        = project(walls[m], x, y);
            const bool   its_end  = s == 0. || s == 1.;
            const auto  &its_near = s == 0. ? walls[m].a : walls[m].b;
            // The other segment has a nearer point, or the same one and comes first.
            if (!its_end || m < k ||
                !same_point(its_near, corner, 1e-9 * (std::abs(w.b[0] - w.a[0]) + std::abs(w.b[1] - w.a[1]))))
              return false;
          }
      }
    const double dx = w.a[0] + t * (w.b[0] - w.a[0]) - x, dy = w.a[1] + t * (w.b[1] - w.a[1]) - y;
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (distance > 0.)
      point = {dx / distance, dy / distance, distance - r};
    else
      point = {0., -1., -r};
    return true;
  }

  ContactCandidates find_candidates(const GrainArrays &g, const WallGeometry &walls, const double skin)
  {
    ContactCandidates candidates;
    const std::size_t n = g.n();
    if (n == 0)
      return candidates;
    for (std::size_t k = 0; k < n; ++k)
      if (!std::isfinite(g.x[k]) || !std::isfinite(g.y[k]))
        throw std::runtime_error("The position of grain " + std::to_string(g.id[k]) + " is not a finite number.");

    const double   r_max = *std::max_element(g.radius.begin(), g.radius.end());
    const CellGrid grid(g, 2. * r_max + skin);
    candidates.discs.reserve(4 * n);

    const auto test = [&](const std::uint32_t p, const std::uint32_t q) {
      const double dx = g.x[p] - g.x[q], dy = g.y[p] - g.y[q], reach = g.radius[p] + g.radius[q] + skin;
      if (dx * dx + dy * dy < reach * reach)
        candidates.discs.push_back(g.id[p] < g.id[q] ? ContactPair{p, q} : ContactPair{q, p});
    };
    for (int row = 0; row < grid.ny; ++row)
      for (int column = 0; column < grid.nx; ++column)
        {
          const std::size_t c = static_cast<std::size_t>(row) * grid.nx + column;
          for (std::uint32_t a = grid.begin[c]; a < grid.begin[c + 1]; ++a)
            {
              const std::uint32_t p = grid.member[a];
              for (std::uint32_t b = a + 1; b < grid.begin[c + 1]; ++b)
                test(p, grid.member[b]);
              if (column + 1 < grid.nx)
                for (std::uint32_t b = grid.begin[c + 1]; b < grid.begin[c + 2]; ++b)
                  test(p, grid.member[b]);
              if (row + 1 < grid.ny)
                {
                  const std::size_t up    = c + grid.nx;
                  const std::size_t first = column > 0 ? up - 1 : up, last = column + 1 < grid.nx ? up + 1 : up;
                  for (std::uint32_t b = grid.begin[first]; b < grid.begin[last + 1]; ++b)
                    test(p, grid.member[b]);
                }
            }
        }
    sort_pairs(candidates.discs, n);

    const auto &segments = walls.segments();
    for (std::size_t k = 0; k < segments.size(); ++k)
      {
        const WallSegment &w     = segments[k];
        const double       reach = r_max + skin, cell_reach = reach + 0.75 * grid.width;
        const double       x_low = std::min(w.a[0], w.b[0]) - reach, x_high = std::max(w.a[0], w.b[0]) + reach;
        const double       y_low = std::min(w.a[1], w.b[1]) - reach, y_high = std::max(w.a[1], w.b[1]) + reach;
        for (int row = grid.row(y_low); row <= grid.row(y_high); ++row)
          for (int column = grid.column(x_low); column <= grid.column(x_high); ++column)
            if (distance_to(w, grid.x0 + (column + 0.5) * grid.width, grid.y0 + (row + 0.5) * grid.width) < cell_reach)
              {
                const std::size_t c = static_cast<std::size_t>(row) * grid.nx + column;
                for (std::uint32_t a = grid.begin[c]; a < grid.begin[c + 1]; ++a)
                  {
                    const std::uint32_t p = grid.member[a];
                    if (distance_to(w, g.x[p], g.y[p]) < g.radius[p] + skin)
                      candidates.walls.push_back({p, static_cast<std::uint32_t>(k)});
                  }
              }
      }
    sort_pairs(candidates.walls, n);
    return candidates;
  }
} // namespace alluvium::grains
