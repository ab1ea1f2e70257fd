#pragma once

#include <mpi.h>

#include <functional>
#include <iosfwd>
#include <string>

namespace alluvium
{
  /**
   * Tells on rank 0 how far the run has come: a bar on a terminal, a line every few seconds elsewhere (a log must not
   * fill up with thousands of them), or nothing.
   */
  class Progress
  {
  public:
    enum class Style
    {
      automatic, // a bar if standard output is a terminal, else lines
      bar,
      lines,
      silent
    };

    /** Seconds on the wall. */
    using Clock = std::function<double()>;

    Progress(
      MPI_Comm communicator, double start_time, double end_time, Style style, std::ostream &out, Clock clock = Clock());

    /** To be called after every step; prints only as often as somebody can read. @p state: how the run is doing. */
    void update(unsigned int step, double time, double time_step, const std::string &state = "");

    /** Print a line of its own; the bar goes on below it. */
    void note(const std::string &text);

    /** Show the last state, whenever it was last shown, and end the line. */
    void finish();

  private:
    void        show();
    std::string left() const;

    const double  start_time, end_time;
    std::ostream &out;
    const Clock   clock;
    Style         style;
    double        interval; // [s] on the wall between two prints

    double       wall_start, wall_last;
    unsigned int step = 0;
    double       time = 0., time_step = 0.;
    std::string  state;
    bool         is_shown = true;
  };

  /** 3725 -> '1:02:05' */
  std::string hours_minutes_seconds(double seconds);
} // namespace alluvium
