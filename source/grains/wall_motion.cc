#include <alluvium/grains/wall_motion.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  namespace
  {
    constexpr unsigned int n_samples = 8; // of a formula, in an interval

    /** Times are sums of time steps: this far apart they are the same [s/s]. */
    constexpr double round_off = 1e-9;

    /** Part of the interval from @p t to t + @p h that lies in the phase. */
    double share(const WallMotion::Phase &phase, const double t, const double h)
    {
      const double both = std::min(t + h, phase.to) - std::max(t, phase.from);
      return h > 0. ? std::max(0., both) / h : 0.;
    }

    bool is_zero(const WallMotion::Velocity &v)
    {
      return v[0] == 0. && v[1] == 0. && v[2] == 0.;
    }
  } // namespace


  WallMotion::Velocity WallMotion::mean_velocity(const double t, const double h) const
  {
    Velocity   result = {{0., 0., 0.}};
    const auto add    = [&](const Velocity &v, const double weight) {
      for (unsigned int d = 0; d < 3; ++d)
        result[d] += weight * v[d];
    };
    for (const Phase &phase : phases)
      {
        double part = share(phase, t, h);
        // what round-off leaves of an interval, or of none
        if (part < round_off)
          continue;
        if (part > 1. - round_off)
          part = 1.;
        if (!phase.at_time)
          {
            add(phase.velocity, part);
            continue;
          }
        const double begin = std::max(t, phase.from);
        for (unsigned int s = 0; s < n_samples; ++s)
          add(phase.at_time(begin + (s + 0.5) / n_samples * part * h), part / n_samples);
      }
    return result;
  }


  bool WallMotion::is_present(const double t) const
  {
    const double same = round_off * std::max(1., std::abs(t));
    return t >= present_from - same && t < present_to - same;
  }


  bool WallMotion::acts(const double t, const double h) const
  {
    if (is_present(t) != is_present(t + h))
      return true;
    return std::any_of(phases.begin(), phases.end(), [&](const Phase &phase) {
      const double part = share(phase, t, h);
      if (part < round_off)
        return false;
      if (!phase.at_time)
        return !is_zero(phase.velocity);
      for (unsigned int s = 0; s <= n_samples; ++s)
        if (!is_zero(phase.at_time(std::min(phase.to, std::max(t, phase.from) + double(s) / n_samples * part * h))))
          return true;
      return false;
    });
  }


  bool WallMotion::ever_acts() const
  {
    return comes_or_goes() || std::any_of(phases.begin(), phases.end(), [](const Phase &phase) {
             return phase.at_time || (phase.from < phase.to && !is_zero(phase.velocity));
           });
  }
} // namespace alluvium::grains
