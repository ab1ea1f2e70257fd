#include <alluvium/deposits/deposit_pour.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::deposits
{
  Pour::Pour(const DepositBox &box, const double largest_radius, const double looseness)
    : box(box)
    , cell(std::max(2. * largest_radius, box.width() / 5e4)) // a wide box of few discs must not cost memory
    , column_width(box.periodic[0] ? box.width() / static_cast<int>(box.width() / cell) : cell)
    , looseness(looseness)
    , n_columns(static_cast<int>(box.width() / cell) + (box.periodic[0] ? 0 : 1))
  {}

  Pour::Disc Pour::seen_from(const double x, const int k) const
  {
    Disc d = discs[k];
    if (box.periodic[0])
      d.x += box.width() * std::round((x - d.x) / box.width());
    return d;
  }

  int Pour::column_of(const double x) const
  {
    return static_cast<int>(std::floor((x - box.lower[0]) / column_width));
  }

  template <class Visit>
  void Pour::visit_columns(const int first, const int last, const Visit &visit) const
  {
    if (!box.periodic[0])
      for (int column = std::max(0, first); column <= std::min(n_columns - 1, last); ++column)
        visit(column);
    else
      for (int column = first; column <= std::min(last, first + n_columns - 1); ++column)
        visit((column % n_columns + n_columns) % n_columns);
  }

  template <class Visit>
  void Pour::visit_near(const double x, const double y, const double reach, const Visit &visit) const
  {
    const int n_rows = static_cast<int>(cells.size()) / n_columns;
    const int r0     = std::max(0, static_cast<int>((y - reach - box.lower[1]) / cell));
    const int r1     = std::min(n_rows - 1, static_cast<int>((y + reach - box.lower[1]) / cell));
    for (int row = r0; row <= r1; ++row)
      visit_columns(column_of(x - reach), column_of(x + reach), [&](const int column) {
        for (const int k : cells[static_cast<std::size_t>(row) * n_columns + column])
          visit(k);
      });
  }

  int Pour::land(const double x, double &y, const double radius, const int except) const
  {
    int       support = -1;
    double    best    = box.lower[1] + radius;
    const int n_rows  = static_cast<int>(cells.size()) / n_columns;
    const int start =
      std::isfinite(y) ? std::min(n_rows - 1, static_cast<int>((y - box.lower[1]) / cell) + 1) : n_rows - 1;
    const double ceiling = y + 1e-9 * radius;
    // Downwards, until no disc of a lower row can reach what has been found.
    for (int row = start; row >= 0 && box.lower[1] + (row + 2) * cell > best; --row)
      visit_columns(column_of(x - cell), column_of(x + cell), [&](const int column) {
        for (const int k : cells[static_cast<std::size_t>(row) * n_columns + column])
          {
            const Disc   d     = seen_from(x, k);
            const double reach = radius + d.r, dx = x - d.x;
            if (k == except || std::abs(dx) >= reach * (1. - 1e-12))
              continue;
            const double top = d.y + std::sqrt(reach * reach - dx * dx);
            if (top > best && top <= ceiling)
              {
                best    = top;
                support = k;
              }
          }
      });
    y = best;
    return support;
  }

  std::array<double, 2> Pour::roll(double x, const double r) const
  {
    double y       = std::numeric_limits<double>::infinity();
    int    support = land(x, y, r, -1);
    for (unsigned int move = 0; support >= 0 && move < 1000; ++move)
      {
        const Disc   c     = seen_from(x, support);
        const double reach = c.r + r, side = x >= c.x ? 1. : -1.;
        // Roll around the support. Angles are from the vertical, positive on our side; the first event ends the roll.
        const double now = std::atan2(side * (x - c.x), y - c.y);
        enum class Event
        {
          falls,
          wall,
          floor,
          disc
        } event      = Event::falls;
        double angle = 0.5 * M_PI;
        int    next  = -1;

        const double wall    = side > 0. ? box.upper[0] - r : box.lower[0] + r;
        const double to_wall = std::max(0., side * (wall - c.x));
        if (!box.periodic[0] && to_wall < reach && std::asin(to_wall / reach) <= angle)
          {
            angle = std::asin(to_wall / reach);
            event = Event::wall;
          }
        const double to_floor = box.lower[1] + r - c.y;
        if (to_floor > 0. && to_floor < reach && std::acos(to_floor / reach) < angle)
          {
            angle = std::acos(to_floor / reach);
            event = Event::floor;
          }
        visit_near(c.x, c.y, 2. * cell, [&](const int k) {
          if (k == support)
            return;
          const Disc   e  = seen_from(c.x, k);
          const double dx = e.x - c.x, dy = e.y - c.y, d2 = dx * dx + dy * dy, d = std::sqrt(d2), other = e.r + r;
          if (d >= reach + other)
            return;
          const double along  = 0.5 * (d2 + reach * reach - other * other) / d;
          const double across = std::sqrt(std::max(0., reach * reach - along * along));
          for (const double s : {-1., 1.})
            {
              const double px = (along * dx - s * across * dy) / d, py = (along * dy + s * across * dx) / d;
              const double a = std::atan2(side * px, py);
              // Only what comes nearer is hit: the support just left touches at the place where this roll begins.
              const bool nearer = side * std::cos(a) * (dx - px) - std::sin(a) * (dy - py) > 0.;
              if (a > now - 1e-9 && a < angle && nearer)
                {
                  angle = a;
                  event = Event::disc;
                  next  = k;
                }
            }
        });

        angle = std::max(angle, now);
        x     = c.x + side * reach * std::sin(angle);
        y     = c.y + reach * std::cos(angle);
        if (event == Event::wall || event == Event::floor)
          break;
        if (event == Event::falls)
          {
            support = land(x, y, r, support);
            continue;
          }
        if (side * (seen_from(x, next).x - x) > 0.) // it rests between its two supports
          break;
        support = next;
      }
    return {{x, y}};
  }

  std::array<double, 2> Pour::add(const double radius, RandomNumbers &random)
  {
    std::array<double, 2> best{{0., std::numeric_limits<double>::infinity()}};
    const bool            stays = looseness > 0. && random.uniform(0., 1.) < looseness;
    for (unsigned int attempt = 0; attempt < (stays ? 1 : 3); ++attempt)
      {
        const double margin = box.periodic[0] ? 0. : radius;
        const double x      = random.uniform(box.lower[0] + margin, box.upper[0] - margin);
        if (stays)
          {
            best = {{x, std::numeric_limits<double>::infinity()}};
            land(x, best[1], radius, -1);
            break;
          }
        const auto place = roll(x, radius);
        if (place[1] < best[1])
          best = place;
      }
    if (double nowhere = 0.; box.periodic[0])
      box.periodicity().wrap(best[0], nowhere, 0);
    const int column = std::clamp(column_of(best[0]), 0, n_columns - 1);
    const int row    = std::max(0, static_cast<int>((best[1] - box.lower[1]) / cell));
    if (cells.size() < static_cast<std::size_t>(row + 1) * n_columns)
      cells.resize(static_cast<std::size_t>(row + 1) * n_columns);
    cells[static_cast<std::size_t>(row) * n_columns + column].push_back(static_cast<int>(discs.size()));
    discs.push_back({best[0], best[1], radius});
    return best;
  }
} // namespace alluvium::deposits
