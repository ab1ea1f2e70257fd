#include <alluvium/deposits/deposit_room.h>
#include <alluvium/grains/wall_crossing.h>
#include <alluvium/utilities/checked_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::deposits
{
  namespace
  {
    /** Does @p wall lie on a side of the box from @p lower to @p upper? */
    bool lies_on_side(const grains::WallSegment   &wall,
                      const std::array<double, 2> &lower,
                      const std::array<double, 2> &upper)
    {
      for (unsigned int d = 0; d < 2; ++d)
        for (const double side : {lower[d], upper[d]})
          if (const double tolerance = 1e-9 * (upper[d] - lower[d]);
              std::abs(wall.a[d] - side) <= tolerance && std::abs(wall.b[d] - side) <= tolerance)
            return true;
      return false;
    }
  } // namespace


  DepositRoom::DepositRoom(const DepositContext &context,
                           const DepositBox     &box,
                           const double          smallest_radius,
                           const double          largest_radius)
    : box(box)
    , smallest(smallest_radius)
    , cell(std::max({2. * largest_radius, box.width() / 1000., box.height() / 1000.}))
    , nx(static_cast<int>(box.width() / cell) + 1)
    , ny(static_cast<int>(box.height() / cell) + 1)
    , boundary(context.sides)
  {
    const auto add = [&](const grains::WallSegment &wall) {
      bool apart = lies_on_side(wall, context.lower, context.upper);
      for (unsigned int d = 0; d < 2; ++d)
        apart = apart || std::max(wall.a[d], wall.b[d]) < box.lower[d] || std::min(wall.a[d], wall.b[d]) > box.upper[d];
      if (!apart)
        segments.push_back(wall);
    };
    for (const grains::WallSegment &wall : context.walls)
      add(wall);
    for (const grains::WallSegment &side : boundary)
      if (std::none_of(context.walls.begin(), context.walls.end(), [&](const grains::WallSegment &wall) {
            return wall.a == side.a && wall.b == side.b;
          }))
        add(side);
    if (segments.empty())
      {
        boundary.clear();
        return;
      }

    near.resize(static_cast<std::size_t>(nx) * ny);
    for (unsigned int k = 0; k < segments.size(); ++k)
      {
        const grains::WallSegment &w     = segments[k];
        const double               reach = largest_radius + 0.75 * cell;
        for (int r = row(std::min(w.a[1], w.b[1]) - reach); r <= row(std::max(w.a[1], w.b[1]) + reach); ++r)
          for (int c = column(std::min(w.a[0], w.b[0]) - reach); c <= column(std::max(w.a[0], w.b[0]) + reach); ++c)
            if (distance_to(w, box.lower[0] + (c + 0.5) * cell, box.lower[1] + (r + 0.5) * cell) < reach)
              near[static_cast<std::size_t>(r) * nx + c].push_back(k);
      }
    in_row.resize(ny);
    for (unsigned int k = 0; k < boundary.size(); ++k)
      for (int r = row(std::min(boundary[k].a[1], boundary[k].b[1]));
           r <= row(std::max(boundary[k].a[1], boundary[k].b[1]));
           ++r)
        in_row[r].push_back(k);
  }


  std::string DepositRoom::in_digits() const
  {
    std::string bytes;
    for (const auto *list : {&segments, &boundary})
      for (const grains::WallSegment &w : *list)
        for (const double x : {w.a[0], w.a[1], w.b[0], w.b[1]})
          bytes.append(reinterpret_cast<const char *>(&x), sizeof x);
    std::ostringstream text;
    text << segments.size() << ", checksum " << std::hex << crc32(bytes);
    return text.str();
  }


  int DepositRoom::column(const double x) const
  {
    return static_cast<int>(std::clamp((x - box.lower[0]) / cell, 0., nx - 1.));
  }


  int DepositRoom::row(const double y) const
  {
    return static_cast<int>(std::clamp((y - box.lower[1]) / cell, 0., ny - 1.));
  }


  bool DepositRoom::inside(const double x, const double y) const
  {
    if (boundary.empty())
      return true;
    // a ray to the right crosses the boundary an odd number of times
    bool result = false;
    for (const unsigned int k : in_row[row(y)])
      if (const auto at = crossing(boundary[k], y); at && *at > x)
        result = !result;
    return result;
  }


  bool DepositRoom::fits(const double x, const double y, const double radius) const
  {
    if (empty())
      return true;
    for (const unsigned int k : near[static_cast<std::size_t>(row(y)) * nx + column(x)])
      if (distance_to(segments[k], x, y) < radius * (1. - 1e-9))
        return false;
    return inside(x, y);
  }


  double DepositRoom::area() const
  {
    if (boundary.empty())
      return box.width() * box.height();
    // Between the levels where the boundary bends, or crosses the box's left or right, the width in the domain is
    // linear in y: the line in the middle has the mean.
    std::vector<double> levels{box.lower[1], box.upper[1]};
    const auto          add = [&](const double y) {
      if (y > box.lower[1] && y < box.upper[1])
        levels.push_back(y);
    };
    for (const grains::WallSegment &w : boundary)
      {
        add(w.a[1]);
        add(w.b[1]);
        for (const double x : {box.lower[0], box.upper[0]})
          if ((w.a[0] - x) * (w.b[0] - x) < 0.)
            add(w.a[1] + (x - w.a[0]) / (w.b[0] - w.a[0]) * (w.b[1] - w.a[1]));
      }
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    double              area = 0.;
    std::vector<double> crossings;
    for (std::size_t l = 0; l + 1 < levels.size(); ++l)
      {
        const double y = 0.5 * (levels[l] + levels[l + 1]), height = levels[l + 1] - levels[l];
        crossings.clear();
        for (const unsigned int k : in_row[row(y)])
          if (const auto at = crossing(boundary[k], y))
            crossings.push_back(std::clamp(*at, box.lower[0], box.upper[0]));
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
          area += height * (crossings[k + 1] - crossings[k]);
      }
    return area;
  }


  std::vector<bool> DepositRoom::reachable(const std::vector<NewGrain> &new_grains) const
  {
    std::vector<bool> result(new_grains.size(), true);
    if (empty() || new_grains.empty())
      return result;
    // Points so close that no way between two neighbours leads through a wall, and where a small disc is but for a
    // little.
    const double spacing = 0.5 * smallest, clearance = 0.7 * smallest;
    double       surface = box.lower[1];
    for (const NewGrain &s : new_grains)
      surface = std::max(surface, s.y + 2. * s.radius);
    surface          = std::min(surface, box.upper[1]);
    const int n_x    = static_cast<int>(box.width() / spacing) + 1,
              n_y    = static_cast<int>((surface - box.lower[1]) / spacing) + 1;
    const auto index = [&](const int c, const int r) { return static_cast<std::size_t>(r) * n_x + c; };
    const auto at_x  = [&](const int c) { return box.lower[0] + (c + 0.5) * spacing; };
    const auto at_y  = [&](const int r) { return box.lower[1] + (r + 0.5) * spacing; };
    enum State : char
    {
      unknown,
      blocked,
      reached
    };
    std::vector<char>                state(static_cast<std::size_t>(n_x) * n_y, unknown);
    std::vector<std::pair<int, int>> to_visit;
    const auto                       visit = [&](int c, const int r) {
      if (box.periodic[0])
        c = (c + n_x) % n_x;
      if (c < 0 || c >= n_x || r < 0 || r >= n_y || state[index(c, r)] != unknown)
        return;
      state[index(c, r)] = fits(at_x(c), at_y(r), clearance) ? reached : blocked;
      if (state[index(c, r)] == reached)
        to_visit.push_back({c, r});
    };

    std::vector<bool> has_sky(n_x, true);
    for (const grains::WallSegment &w : segments)
      {
        const double x0 = std::min(w.a[0], w.b[0]) - clearance, x1 = std::max(w.a[0], w.b[0]) + clearance;
        for (int c = std::max(0, static_cast<int>((x0 - box.lower[0]) / spacing - 0.5));
             c <= std::min<double>(n_x - 1, (x1 - box.lower[0]) / spacing);
             ++c)
          {
            if (at_x(c) < x0 || at_x(c) > x1)
              continue;
            const double ex  = w.b[0] - w.a[0];
            double       top = std::max(w.a[1], w.b[1]);
            if (std::abs(ex) > 2. * clearance)
              {
                top = std::numeric_limits<double>::lowest();
                for (const double x : {at_x(c) - clearance, at_x(c) + clearance})
                  top = std::max(top, w.a[1] + std::clamp((x - w.a[0]) / ex, 0., 1.) * (w.b[1] - w.a[1]));
              }
            if (top >= at_y(n_y - 1))
              has_sky[c] = false;
          }
      }
    if (std::none_of(has_sky.begin(), has_sky.end(), [](const bool sky) { return sky; }))
      has_sky.assign(n_x, true);
    for (int c = 0; c < n_x; ++c)
      if (has_sky[c])
        visit(c, n_y - 1);
    while (!to_visit.empty())
      {
        const auto [c, r] = to_visit.back();
        to_visit.pop_back();
        visit(c + 1, r);
        visit(c - 1, r);
        visit(c, r + 1);
        visit(c, r - 1);
      }

    for (std::size_t k = 0; k < new_grains.size(); ++k)
      {
        const NewGrain &s = new_grains[k];
        result[k]         = false;
        if (!fits(s.x, s.y, s.radius))
          continue;
        const int c = static_cast<int>((s.x - box.lower[0]) / spacing),
                  r = static_cast<int>((s.y - box.lower[1]) / spacing);
        for (int q = std::max(0, r - 2); q <= std::min(n_y - 1, r + 2); ++q)
          for (int p = std::max(0, c - 2); p <= std::min(n_x - 1, c + 2); ++p)
            result[k] = result[k] ||
                        (state[index(p, q)] == reached && std::hypot(at_x(p) - s.x, at_y(q) - s.y) < 0.99 * s.radius);
      }
    return result;
  }
} // namespace alluvium::deposits
