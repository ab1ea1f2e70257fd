#include <alluvium/run/kinks.h>
#include <alluvium/run/model.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace alluvium::run
{
  namespace
  {
    using Function = std::function<double(double)>;

    /** Second difference over the interval of @p width around @p middle. */
    double bend(const Function &f, const double middle, const double width)
    {
      return std::abs(f(middle - 0.5 * width) - 2. * f(middle) + f(middle + 0.5 * width));
    }

    /** Where in the interval of @p width around @p middle the second difference over half of it is largest. */
    double most_bent_half(const Function &f, const double middle, const double width)
    {
      double best = middle, most = bend(f, middle, 0.5 * width);
      for (const double candidate : {middle - 0.25 * width, middle + 0.25 * width})
        if (const double bent = bend(f, candidate, 0.5 * width); bent > most)
          {
            most = bent;
            best = candidate;
          }
      return best;
    }
  } // namespace


  std::vector<double> find_kinks(const Function &f, const double from, const double to)
  {
    constexpr unsigned int n_samples = 10000, most_kinks = 300;
    // After n halvings the bend of a smooth function has fallen to 4^-n, that of a kink to 2^-n, a jump keeps it.
    constexpr unsigned int n_halvings = 12;
    const double           threshold  = std::pow(2., -1.5 * n_halvings);
    std::vector<double>    result;
    if (!(to > from))
      return result;

    const double        spacing = (to - from) / n_samples;
    std::vector<double> samples(n_samples + 1);
    for (unsigned int i = 0; i <= n_samples; ++i)
      samples[i] = f(from + i * spacing);
    const auto [least, largest] = std::minmax_element(samples.begin(), samples.end());
    const double round_off      = 1e-12 * std::max({std::abs(*least), std::abs(*largest), *largest - *least});

    for (unsigned int i = 1; i < n_samples; ++i)
      {
        if (!(std::abs(samples[i - 1] - 2. * samples[i] + samples[i + 1]) > 1e3 * round_off))
          continue;
        double middle = from + i * spacing, width = 2. * spacing;
        // where a smooth function has a point of inflection, its neighbours tell how it bends
        const double at_first = std::max(
          {bend(f, middle, width), bend(f, middle - 0.5 * width, width), bend(f, middle + 0.5 * width, width)});
        for (unsigned int n = 0; n < n_halvings; ++n, width *= 0.5)
          middle = most_bent_half(f, middle, width);
        const double left = bend(f, middle, width);
        if (!(left > threshold * at_first && left > 4. * round_off))
          continue;
        while (bend(f, middle, width) > 4. * round_off && width > 1e-15 * std::abs(middle))
          {
            middle = most_bent_half(f, middle, width);
            width *= 0.5;
          }
        // of a jump, the last time before it
        double before = middle - width, after = middle + width;
        if (std::abs(f(after) - f(before)) > 1e-6 * std::abs(*largest - *least))
          {
            const double value = f(before), other = f(after);
            while (std::nextafter(before, after) < after)
              {
                const double t = 0.5 * (before + after);
                if (!(t > before && t < after))
                  break;
                (std::abs(f(t) - value) < std::abs(f(t) - other) ? before : after) = t;
              }
            middle = before;
          }
        if (middle > from && middle < to && (result.empty() || middle - result.back() > 1e-3 * spacing))
          result.push_back(middle);
        if (result.size() > most_kinks)
          return {};
      }
    return result;
  }


  std::vector<double> given_kinks(const Model &m, const double end_time)
  {
    std::vector<double> result;
    const auto          look_at = [&](const Function &f, const double from, const double to) {
      const auto found = find_kinks(f, from, to);
      result.insert(result.end(), found.begin(), found.end());
    };
    if (m.has_fluid)
      {
        // formulas are defined everywhere, and plug-ins should be: some points of the box stand for the boundary
        const auto                     &lower = m.domain.lower(), &upper = m.domain.upper();
        constexpr std::array<double, 3> shares = {{0.01, 0.5, 0.97}};
        for (const auto &[id, condition] : m.boundary_conditions.all())
          if (condition.value && condition.may_depend_on("t"))
            for (unsigned int c = 0; c < condition.value->n_components; ++c)
              for (const double x : shares)
                for (const double y : shares)
                  look_at(
                    [&, component = c, function = condition.value](const double t) {
                      function->set_time(t);
                      return function->value({(1. - x) * lower[0] + x * upper[0], (1. - y) * lower[1] + y * upper[1]},
                                             component);
                    },
                    0.,
                    end_time);
        for (const auto &[id, condition] : m.boundary_conditions.all())
          if (condition.value)
            condition.value->set_time(m.boundary_conditions.current_time());
        for (const auto &driving : m.solver.driving_functions())
          look_at(driving.component, 0., end_time);
      }
    for (const auto &wall : m.contacts.walls())
      if (wall.motion)
        {
          for (const double t : {wall.motion->present_from, wall.motion->present_to})
            result.push_back(t);
          for (const auto &phase : wall.motion->phases)
            {
              result.push_back(phase.from);
              result.push_back(phase.to);
              if (phase.at_time)
                for (unsigned int c = 0; c < 3; ++c)
                  // the formula need not be defined outside its phase
                  look_at([&, c](const double t) { return phase.at_time(std::clamp(t, phase.from, phase.to))[c]; },
                          std::max(0., phase.from),
                          std::min(end_time, phase.to));
            }
        }
    result.erase(
      std::remove_if(result.begin(), result.end(), [&](const double t) { return !(t > 0. && t < end_time); }),
      result.end());
    std::sort(result.begin(), result.end());
    // what two functions say of one time differs by round-off: the earlier one counts
    const double same = 1e-9 * end_time;
    result.erase(
      std::unique(result.begin(), result.end(), [&](const double a, const double b) { return b - a < same; }),
      result.end());
    return result;
  }
} // namespace alluvium::run
