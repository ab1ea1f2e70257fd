#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/pair_sort.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace alluvium::contacts
{
  namespace
  {
    bool same_point(const std::array<double, 2> &p, const std::array<double, 2> &q, const double tolerance)
    {
      return std::abs(p[0] - q[0]) <= tolerance && std::abs(p[1] - q[1]) <= tolerance;
    }

    double length_of(const grains::WallSegment &w)
    {
      return std::hypot(w.b[0] - w.a[0], w.b[1] - w.a[1]);
    }

    // of the longer of two segments: points nearer to each other are the same
    constexpr double same_point_tolerance = 1e-9;

    /** Grains sorted into the cells of a grid over their bounding box, or over the box where it is periodic. */
    struct CellGrid
    {
      double                     x0, y0, width_x, width_y;
      int                        nx, ny;
      std::vector<std::uint32_t> begin, member; // grains of cell c: member[begin[c]] ... member[begin[c + 1] - 1]

      // Towards zero is downwards, except where clamping makes it 0 anyway.
      int column(const double x) const { return std::clamp(static_cast<int>((x - x0) / width_x), 0, nx - 1); }
      int row(const double y) const { return std::clamp(static_cast<int>((y - y0) / width_y), 0, ny - 1); }

      CellGrid(const grains::GrainArrays &g, const grains::Periodicity &periodicity, const double smallest_width)
      {
        const auto [x_min, x_max] = std::minmax_element(g.position[0].begin(), g.position[0].end());
        const auto [y_min, y_max] = std::minmax_element(g.position[1].begin(), g.position[1].end());
        const bool   px = periodicity.length[0] > 0., py = periodicity.length[1] > 0.;
        const double lx = px ? periodicity.length[0] : *x_max - *x_min,
                     ly = py ? periodicity.length[1] : *y_max - *y_min;
        x0              = px ? periodicity.lower[0] : *x_min;
        y0              = py ? periodicity.lower[1] : *y_min;
        double width    = smallest_width;
        // One grain that flew far away must not cost the memory of all the cells in between.
        while ((lx / width + 1.) * (ly / width + 1.) > 1024. + 8. * g.n())
          width *= 1.5;
        // Cells of a periodic direction fill the box; the others end somewhere behind the last grain.
        nx      = px ? std::max(1, static_cast<int>(lx / width)) : static_cast<int>(lx / width) + 1;
        ny      = py ? std::max(1, static_cast<int>(ly / width)) : static_cast<int>(ly / width) + 1;
        width_x = px ? lx / nx : width;
        width_y = py ? ly / ny : width;

        std::vector<std::uint32_t> cell(g.n());
        begin.assign(static_cast<std::size_t>(nx) * ny + 1, 0);
        for (std::size_t k = 0; k < g.n(); ++k)
          {
            cell[k] = row(g.position[1][k]) * nx + column(g.position[0][k]);
            ++begin[cell[k] + 1];
          }
        for (std::size_t c = 1; c < begin.size(); ++c)
          begin[c] += begin[c - 1];
        member.resize(g.n());
        std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
        for (std::size_t k = 0; k < g.n(); ++k)
          member[end[cell[k]]++] = k;
        wrap_x = px;
        wrap_y = py;
      }

      /** The neighbours that cell @p c is to be paired with, so that every two neighbours are paired once. */
      const std::vector<std::uint32_t> &partners(const std::uint32_t c) const
      {
        const int  column = c % nx, row = c / nx;
        const bool few = this->few();
        found.clear();
        for (const auto &[x, y] : {std::array<int, 2>{{1, 0}}, {{-1, 1}}, {{0, 1}}, {{1, 1}}})
          for (const int sign : {1, -1})
            if (sign == 1 || few)
              {
                int cx = column + sign * x, cy = row + sign * y;
                if (wrap_x)
                  cx = (cx + nx) % nx;
                if (wrap_y)
                  cy = (cy + ny) % ny;
                if (cx < 0 || cx >= nx || cy < 0 || cy >= ny)
                  continue;
                const std::uint32_t other = static_cast<std::uint32_t>(cy) * nx + cx;
                if (!few || (other > c && std::find(found.begin(), found.end(), other) == found.end()))
                  found.push_back(other);
              }
        return found;
      }

      /** Whether cells on opposite sides are neighbours. */
      bool wraps() const { return wrap_x || wrap_y; }

      /** With fewer than three cells in a period, a cell has the same neighbour on both sides. */
      bool few() const { return (wrap_x && nx < 3) || (wrap_y && ny < 3); }

    private:
      bool                               wrap_x, wrap_y;
      mutable std::vector<std::uint32_t> found;
    };
  } // namespace

  void WallGeometry::set(std::vector<grains::WallSegment> segments)
  {
    walls  = std::move(segments);
    moving = std::any_of(walls.begin(), walls.end(), grains::ever_acts);
    find_meetings();
  }

  std::vector<double> WallGeometry::positions() const
  {
    return moving ? positions_of(walls) : std::vector<double>();
  }

  std::vector<double> WallGeometry::positions_of(const std::vector<grains::WallSegment> &segments)
  {
    std::vector<double> result;
    for (const grains::WallSegment &w : segments)
      result.insert(result.end(), {w.a[0], w.a[1], w.b[0], w.b[1], w.centre[0], w.centre[1], double(w.present)});
    return result;
  }

  void WallGeometry::place(const std::vector<double> &positions)
  {
    if (positions.empty())
      return;
    constexpr std::size_t n_each = 7;
    check_user(positions.size() == n_each * walls.size(), "The checkpoint is of a scene with other walls.");
    moving = true; // they have moved: the next checkpoint must know
    for (std::size_t k = 0; k < walls.size(); ++k)
      {
        const double *const p = &positions[n_each * k];
        walls[k].a            = {{p[0], p[1]}};
        walls[k].b            = {{p[2], p[3]}};
        walls[k].centre       = {{p[4], p[5]}};
        walls[k].present      = p[6] != 0.;
      }
    find_meetings();
  }

  double WallGeometry::largest_speed() const
  {
    double speed = 0.;
    for (const grains::WallSegment &w : walls)
      if (w.present)
        speed = std::max(speed, speed_of(w));
    return speed;
  }

  bool WallGeometry::act(const double dt) const
  {
    return std::any_of(walls.begin(), walls.end(), [&](const grains::WallSegment &w) {
      return w.motion ? w.present != w.motion->is_present(time) || w.motion->acts(time, dt) : ever_acts(w);
    });
  }

  void WallGeometry::begin_substep(const double h)
  {
    if (moving)
      for (grains::WallSegment &w : walls)
        if (w.motion)
          {
            const auto v = w.motion->mean_velocity(time, h);
            w.velocity   = {{v[0], v[1]}};
            w.spin       = v[2];
            w.present    = w.motion->is_present(time);
          }
  }

  unsigned int WallGeometry::count_substeps(const double dt, const double smallest_diameter) const
  {
    // a wall that turns leaves the tangent on which contacts see it move
    double      n = 1.;
    std::string fastest;
    for (const grains::WallSegment &w : walls)
      {
        const double spin = w.motion ? w.motion->mean_velocity(time, dt)[2] : w.spin;
        if (spin == 0.)
          continue;
        double arm = 0.;
        for (const auto &end : {w.a, w.b})
          arm = std::max(arm, std::hypot(end[0] - w.centre[0], end[1] - w.centre[1]));
        const double most = std::min(0.1, std::sqrt(0.1 * smallest_diameter / arm)); // [rad]
        if (const double wanted = std::ceil(std::abs(spin) * dt / most * (1. - 1e-10)); wanted > n)
          {
            n       = wanted;
            fastest = "The wall '" + w.name + "' turns at " + in_digits(spin) + " rad/s";
          }
      }
    if (n > 1e6)
      throw Divergence(fastest + ": a step of " + in_digits(dt) +
                       " s would need more than a million contact sub-steps.");
    return static_cast<unsigned int>(n);
  }

  void WallGeometry::find_meetings()
  {
    meeting.assign(walls.size(), {});
    for (std::size_t k = 0; k < walls.size(); ++k)
      for (std::size_t m = k + 1; m < walls.size(); ++m)
        {
          const grains::WallSegment &w = walls[k], &other = walls[m];
          const double               tolerance = same_point_tolerance * std::max(length_of(w), length_of(other));
          bool                       apart     = false;
          for (unsigned int d = 0; d < 2; ++d)
            apart = apart || std::min(w.a[d], w.b[d]) - std::max(other.a[d], other.b[d]) > tolerance ||
                    std::min(other.a[d], other.b[d]) - std::max(w.a[d], w.b[d]) > tolerance;
          if (apart)
            continue;
          const auto lies_on = [&](const std::array<double, 2> &p, const grains::WallSegment &segment) {
            return distance_to(segment, p[0], p[1]) <= tolerance;
          };
          if (lies_on(w.a, other) || lies_on(w.b, other) || lies_on(other.a, w) || lies_on(other.b, w))
            {
              meeting[k].push_back(m);
              meeting[m].push_back(k);
            }
        }
  }

  void WallGeometry::move(const double dt)
  {
    time += dt;
    if (!moving)
      return;
    bool moved = false;
    for (grains::WallSegment &w : walls)
      {
        std::array<double, 2> step = {{dt * w.velocity[0], dt * w.velocity[1]}};
        if (w.spin == 0. && !w.rigid)
          {
            const double ex = w.b[0] - w.a[0], ey = w.b[1] - w.a[1], e2 = ex * ex + ey * ey;
            const double along = e2 == 0. ? 0. : (w.velocity[0] * ex + w.velocity[1] * ey) / e2;
            step               = {{dt * (w.velocity[0] - along * ex), dt * (w.velocity[1] - along * ey)}};
          }
        if (w.spin != 0.)
          {
            const double c = std::cos(w.spin * dt), s = std::sin(w.spin * dt);
            for (auto *end : {&w.a, &w.b})
              {
                const double x = (*end)[0] - w.centre[0], y = (*end)[1] - w.centre[1];
                *end = {{w.centre[0] + c * x - s * y, w.centre[1] + s * x + c * y}};
              }
          }
        for (auto *point : {&w.a, &w.b, &w.centre})
          for (unsigned int d = 0; d < 2; ++d)
            (*point)[d] += step[d];
        moved = moved || w.spin != 0. || step[0] != 0. || step[1] != 0.;
      }
    if (moved)
      find_meetings();
  }

  bool
  WallGeometry::touch(const std::size_t k, const double x, const double y, const double r, ContactPoint &point) const
  {
    const grains::WallSegment &w = walls[k];
    if (!w.present)
      return false;
    const double t      = project(w, x, y);
    const double near_x = w.a[0] + t * (w.b[0] - w.a[0]), near_y = w.a[1] + t * (w.b[1] - w.a[1]);
    for (const std::uint32_t m : meeting[k])
      {
        const grains::WallSegment &other     = walls[m];
        const double               tolerance = same_point_tolerance * std::max(length_of(w), length_of(other));
        if (!other.present || distance_to(other, near_x, near_y) > tolerance)
          continue; // what this segment has nearest is no point of the other one
        const double s = project(other, x, y);
        // The other segment has a nearer point, or the same one and comes first.
        if (m < k ||
            !same_point({{near_x, near_y}},
                        {{other.a[0] + s * (other.b[0] - other.a[0]), other.a[1] + s * (other.b[1] - other.a[1])}},
                        tolerance))
          return false;
      }
    const double dx = near_x - x, dy = near_y - y;
    const double distance = std::sqrt(dx * dx + dy * dy);
    if (distance > 0.)
      point = {dx / distance, dy / distance, distance - r};
    else
      point = {0., -1., -r};
    const auto v = w.velocity_at(x + dx, y + dy);
    point.vx     = v[0];
    point.vy     = v[1];
    return true;
  }

  void wrap_into_box(grains::GrainArrays &g, const grains::Periodicity &periodicity)
  {
    if (periodicity.any())
      for (std::size_t k = 0; k < g.n(); ++k)
        {
          periodicity.wrap(g.position[0][k], g.initial_position[0][k], 0);
          periodicity.wrap(g.position[1][k], g.initial_position[1][k], 1);
        }
  }

  ContactPoint touch(const grains::GrainArrays &g,
                     const grains::Periodicity &periodicity,
                     const std::uint32_t        i,
                     const std::uint32_t        j)
  {
    double dx = g.position[0][j] - g.position[0][i], dy = g.position[1][j] - g.position[1][i];
    periodicity.shorten(dx, dy);
    const double distance = std::sqrt(dx * dx + dy * dy), gap = distance - (g.radius[i] + g.radius[j]);
    return distance > 0. ? ContactPoint{dx / distance, dy / distance, gap} : ContactPoint{1., 0., gap};
  }

  namespace
  {
    /** All pairs of grains with gaps below @p skin, sorted. */
    std::vector<ContactPair> find_pairs(const grains::GrainArrays &g,
                                        const grains::Periodicity &periodicity,
                                        const CellGrid            &grid,
                                        const double               skin)
    {
      // In the order of the cells, so that what is tested together lies together
      struct Body
      {
        double        x, y, radius;
        std::uint32_t number, id;
      };
      std::vector<Body> bodies(g.n());
      for (std::size_t k = 0; k < bodies.size(); ++k)
        {
          const std::uint32_t m = grid.member[k];
          bodies[k]             = {g.position[0][m], g.position[1][m], g.radius[m], m, g.id[m]};
        }
      struct Pair
      {
        std::uint32_t i, j;
      };
      std::vector<Pair> found(3 * g.n());
      std::size_t       n_found = 0;
      const auto        test    = [&](const Body &p, const std::uint32_t begin, const std::uint32_t end) {
        if (n_found + (end - begin) > found.size())
          found.resize(found.size() + found.size() / 4 + (end - begin));
        for (std::uint32_t k = begin; k < end; ++k)
          {
            const Body &q  = bodies[k];
            double      dx = p.x - q.x, dy = p.y - q.y;
            periodicity.shorten(dx, dy);
            const double reach = p.radius + q.radius + skin;
            // Nobody can predict which are near: write the pair down in any case, and keep it if so.
            const std::uint32_t first = p.id < q.id ? p.number : q.number;
            found[n_found]            = {first, p.number ^ q.number ^ first};
            n_found += dx * dx + dy * dy < reach * reach;
          }
      };
      const std::vector<std::uint32_t> &begin = grid.begin;
      for (int row = 0; row < grid.ny; ++row)
        for (int column = 0; column < grid.nx; ++column)
          {
            const std::uint32_t c    = static_cast<std::uint32_t>(row) * grid.nx + column;
            const bool          edge = grid.wraps() && (column == 0 || column + 1 == grid.nx || row + 1 == grid.ny);
            if (begin[c] == begin[c + 1])
              continue;
            if (edge || grid.few())
              {
                const std::vector<std::uint32_t> &others = grid.partners(c);
                for (std::uint32_t a = begin[c]; a < begin[c + 1]; ++a)
                  {
                    test(bodies[a], a + 1, begin[c + 1]);
                    for (const std::uint32_t other : others)
                      test(bodies[a], begin[other], begin[other + 1]);
                  }
                continue;
              }
            // The rest of the cell and the one to the right; the three above, which lie one behind the other
            const std::uint32_t right = column + 1 < grid.nx ? c + 1 : c;
            const bool          above = row + 1 < grid.ny;
            const std::uint32_t first = begin[above ? c + grid.nx - (column > 0 ? 1 : 0) : 0],
                                last  = begin[above ? right + grid.nx + 1 : 0];
            for (std::uint32_t a = begin[c]; a < begin[c + 1]; ++a)
              {
                test(bodies[a], a + 1, begin[right + 1]);
                test(bodies[a], first, last);
              }
          }
      found.resize(n_found);
      sort_pairs(found, g.n());
      std::vector<ContactPair> pairs(found.size());
      for (std::size_t k = 0; k < found.size(); ++k)
        {
          pairs[k].i = found[k].i;
          pairs[k].j = found[k].j;
        }
      return pairs;
    }
  } // namespace

  ContactCandidates find_candidates(const grains::GrainArrays &g, const ContactGeometry &geometry, const double skin)
  {
    ContactCandidates candidates;
    const std::size_t n = g.n();
    if (n == 0)
      return candidates;
    for (std::size_t k = 0; k < n; ++k)
      if (!std::isfinite(g.position[0][k]) || !std::isfinite(g.position[1][k]))
        throw Divergence("The position of grain " + std::to_string(g.id[k]) + " is not a finite number.");

    const grains::Periodicity &periodicity = geometry.periodicity;
    const double               r_max       = *std::max_element(g.radius.begin(), g.radius.end());
    for (const double length : periodicity.length)
      check_user(length == 0. || length > 2. * (2. * r_max + skin),
                 "Domain/Periodic directions: the domain must be wider than two of the largest grains (and twice the "
                 "distance at which contacts are looked for), or a grain would touch another one on both sides.");
    const CellGrid grid(g, periodicity, 2. * r_max + skin);
    candidates.discs = find_pairs(g, periodicity, grid, skin);

    const auto &segments = geometry.walls.segments();
    for (std::size_t k = 0; k < segments.size(); ++k)
      {
        const grains::WallSegment &w = segments[k];
        const double reach = r_max + skin, cell_reach = reach + 0.75 * std::max(grid.width_x, grid.width_y);
        const double x_low = std::min(w.a[0], w.b[0]) - reach, x_high = std::max(w.a[0], w.b[0]) + reach;
        const double y_low = std::min(w.a[1], w.b[1]) - reach, y_high = std::max(w.a[1], w.b[1]) + reach;
        for (int row = grid.row(y_low); row <= grid.row(y_high); ++row)
          for (int column = grid.column(x_low); column <= grid.column(x_high); ++column)
            if (distance_to(w, grid.x0 + (column + 0.5) * grid.width_x, grid.y0 + (row + 0.5) * grid.width_y) <
                cell_reach)
              {
                const std::size_t c = static_cast<std::size_t>(row) * grid.nx + column;
                for (std::uint32_t a = grid.begin[c]; a < grid.begin[c + 1]; ++a)
                  {
                    const std::uint32_t p = grid.member[a];
                    if (distance_to(w, g.position[0][p], g.position[1][p]) < g.radius[p] + skin)
                      candidates.walls.push_back({p, static_cast<std::uint32_t>(k)});
                  }
              }
      }
    sort_pairs(candidates.walls, n);
    return candidates;
  }
} // namespace alluvium::contacts
