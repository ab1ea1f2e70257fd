#include <alluvium/run/model.h>
#include <alluvium/run/poles.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  namespace
  {
    using Function = std::function<double(double)>;

    /**
     * Within @p width around @p middle, and in [@p from, @p to]: does |f| go beyond all bounds somewhere? It is at most
     * @p beside that far away.
     */
    std::optional<Pole>
    zoom_in(const Function &f, double middle, double width, const double beside, const double from, const double to)
    {
      // a pole still grows where a peak looks level; what is random does neither
      constexpr int    n_points = 10;
      constexpr double closest = 1e-12, near = 1e-10, farther = 1e-7, growth = 10., large = 1e3;
      const double     unit = std::max({std::abs(middle), width, 1e-3 * (to - from)});
      double           size = std::abs(f(middle));
      for (; width > closest * unit; width /= n_points)
        {
          const double centre = middle;
          for (int k = -n_points; k <= n_points; ++k)
            {
              const double t = std::clamp(centre + width * k / n_points, from, to), now = f(t);
              if (!std::isfinite(now))
                return Pole{t, now};
              if (std::abs(now) > size)
                {
                  middle = t;
                  size   = std::abs(now);
                }
            }
        }
      if (size < large * beside)
        return {};
      for (const double side : {-1., 1.})
        {
          const double t = middle + side * farther * unit;
          if (t >= from && t <= to && std::abs(f(middle + side * near * unit)) > growth * std::abs(f(t)))
            return Pole{middle, f(middle)};
        }
      return {};
    }

    /** The times at which the steps of the run end; of many, so many evenly chosen ones. */
    std::vector<double> times_of_steps(const double from, const double to, const double dt)
    {
      constexpr double    most = 1e4, fewest = 1e3;
      const double        n_steps = std::max(1., std::ceil((to - from) / dt - 1e-6));
      const double        stride  = n_steps > most ? std::ceil(n_steps / most) : 1. / std::ceil(fewest / n_steps);
      std::vector<double> times;
      for (double k = 0.; from + k * stride * dt < to; k += 1.)
        times.push_back(from + k * stride * dt);
      times.push_back(to);
      return times;
    }

    /** Throws UserError if @p f, which is @p text in @p where, is not finite at all @p times, or between them. */
    void check(const std::string &where, const std::string &text, const Function &f, const std::vector<double> &times)
    {
      if (const auto pole = find_pole(f, times))
        throw UserError(
          where + ": '" + text + "' " +
          (std::isfinite(pole->value) ? "grows beyond all bounds near" : "is " + in_digits(pole->value) + " at") +
          " t = " + in_digits(pole->time) + " s; expected finite numbers during the whole run.");
    }

    void check_conditions(Model &m, const std::vector<double> &times)
    {
      auto &conditions = m.boundary_conditions;
      for (const auto &[id, condition] : conditions.all())
        if (condition.value && condition.may_depend_on("t"))
          for (const auto &side : m.domain.sides())
            if (side.name == condition.name)
              for (const double s : {0.02, 0.25, 0.5, 0.75, 0.98})
                {
                  const dealii::Point<Model::dim> x(side.a[0] + s * (side.b[0] - side.a[0]),
                                                    side.a[1] + s * (side.b[1] - side.a[1]));
                  for (unsigned int c = 0; c < condition.value->n_components; ++c)
                    check(
                      condition.described() + " at x = " + in_digits(x[0]) + ", y = " + in_digits(x[1]),
                      condition.text,
                      [&, function = condition.value](const double t) {
                        function->set_time(t);
                        return function->value(x, c);
                      },
                      times);
                }
      conditions.set_time(m.time);
    }

    void check_wall(const grains::WallSegment &wall, const std::vector<double> &times)
    {
      if (!wall.motion)
        return;
      for (const auto &phase : wall.motion->phases)
        {
          if (!phase.at_time)
            continue;
          std::vector<double> moving;
          for (const double t : times)
            if (t >= phase.from && t <= phase.to)
              moving.push_back(t);
          for (const double t : {phase.from, phase.to})
            if (t > times.front() && t < times.back())
              moving.push_back(t);
          std::sort(moving.begin(), moving.end());
          for (unsigned int c = 0; c < 3 && !moving.empty(); ++c)
            check(
              "Grains/Motion of walls: '" + wall.name + "'",
              phase.text,
              [&](const double t) { return phase.at_time(t)[c]; },
              moving);
        }
    }
  } // namespace


  std::optional<Pole> find_pole(const Function &f, const std::vector<double> &times)
  {
    const std::size_t   n = times.size();
    std::vector<double> size(n);
    for (std::size_t i = 0; i < n; ++i)
      {
        const double value = f(times[i]);
        if (!std::isfinite(value))
          return Pole{times[i], value};
        size[i] = std::abs(value);
      }
    if (n < 2)
      return {};
    const double largest = *std::max_element(size.begin(), size.end());
    for (std::size_t i = 0; i < n; ++i)
      {
        const std::size_t before = i == 0 ? 1 : i - 1, after = i + 1 == n ? n - 2 : i + 1;
        // near a pole the nearest sample is much larger than the next but one
        if (size[i] < 0.1 * largest || size[i] < std::max(size[before], size[after]) ||
            size[i] < 1.5 * std::min(size[before], size[after]) || size[i] == 0.)
          continue;
        const double width  = std::max(std::abs(times[before] - times[i]), std::abs(times[after] - times[i]));
        const double beside = std::max(size[before], size[after]);
        if (const auto pole = zoom_in(f, times[i], width, beside, times.front(), times.back()))
          return pole;
      }
    return {};
  }


  void check_poles(Model &m, const double end_time)
  {
    if (!m.has_fluid || !(end_time > m.time))
      return;
    const std::vector<double> times = times_of_steps(m.time, end_time, m.time_step);
    check_conditions(m, times);
    for (const auto &driving : m.solver.driving_functions())
      check(driving.parameter, driving.text, driving.component, times);
    m.adaptivity.check_until(end_time, m.refinement_context());
  }


  void check_poles_of_walls(const Model &m, const double end_time)
  {
    if (end_time > m.time)
      for (const auto &wall : m.contacts.walls())
        check_wall(wall, times_of_steps(m.time, end_time, m.time_step));
  }
} // namespace alluvium::run
