#pragma once

#include <functional>

namespace alluvium
{
  /**
   * Whether a run takes far longer than was expected when it started: looked at when it has run for some seconds, and
   * each time that has doubled.
   */
  class Pace
  {
  public:
    /** Seconds on the wall. */
    using Clock = std::function<double()>;

    /** Of a run from @p start_time to @p end_time [s] that is expected to take @p expected seconds on the wall. */
    Pace(double start_time, double end_time, double expected, Clock clock = Clock());

    /** After a step that ended at @p time [s]: true once, when the rest is known to take much longer. */
    bool falls_behind(double time);

    /** What was expected, and what it takes at the pace of late, from start to end [s on the wall]. */
    double expected() const { return expected_duration; }
    double duration() const { return likely_duration; }

  private:
    const double end_time, expected_duration;
    const Clock  clock;
    const double wall_start;
    double       time_then, wall_then; // when it was last looked at
    double       next_look;            // [s] after the start
    double       likely_duration = 0.;
    bool         was_said        = false;
  };
} // namespace alluvium
