#include <alluvium/utilities/pace.h>
#include <alluvium/utilities/timers.h>

#include <algorithm>
#include <limits>

namespace alluvium
{
  namespace
  {
    constexpr double first_look = 7.5; // [s]
  } // namespace


  Pace::Pace(const double start_time, const double end_time, const double expected, Clock wall_clock)
    : end_time(end_time)
    , expected_duration(expected)
    , clock(wall_clock ? std::move(wall_clock) : Clock(wall_seconds))
    , wall_start(clock())
    , time_then(start_time)
    , wall_then(wall_start)
    , next_look(first_look)
  {}


  bool Pace::falls_behind(const double time)
  {
    if (was_said)
      return false;
    const double now = clock(), elapsed = now - wall_start;
    if (elapsed < next_look)
      return false;
    const double speed  = (time - time_then) / (now - wall_then);
    likely_duration     = elapsed + (speed > 0. ? (end_time - time) / speed : std::numeric_limits<double>::infinity());
    const bool is_first = next_look == first_look;
    next_look           = 2. * elapsed;
    time_then           = time;
    wall_then           = now;
    // chosen steps are short at first, and a minute annoys nobody
    constexpr double much = 10., least = 60.;
    was_said = !is_first && likely_duration > std::max(much * expected_duration, least);
    return was_said;
  }
} // namespace alluvium
