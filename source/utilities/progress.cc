#include <alluvium/utilities/progress.h>
#include <alluvium/utilities/timers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include <sys/ioctl.h>
#include <unistd.h>

namespace alluvium
{
  namespace
  {
    /** Of the terminal that standard output is; much, where it is none. */
    std::size_t terminal_width()
    {
      winsize size;
      return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 1000;
    }

    template <typename... Values>
    std::string formatted(const char *format, const Values... values)
    {
      char text[200];
      std::snprintf(text, sizeof(text), format, values...);
      return text;
    }
  } // namespace

  std::string hours_minutes_seconds(const double seconds)
  {
    if (!std::isfinite(seconds) || seconds < 0 || seconds > 1e9)
      return "?";
    const long s = std::lround(seconds);
    return formatted("%ld:%02ld:%02ld", s / 3600, (s / 60) % 60, s % 60);
  }

  Progress::Progress(MPI_Comm      communicator,
                     const double  start_time,
                     const double  end_time,
                     const Style   wanted,
                     std::ostream &out,
                     Clock         wall_clock)
    : start_time(start_time)
    , end_time(end_time)
    , out(out)
    , clock(wall_clock ? std::move(wall_clock) : Clock(wall_seconds))
    , style(wanted)
    , time(start_time)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    if (rank != 0)
      style = Style::silent;
    else if (style == Style::automatic)
      style = isatty(STDOUT_FILENO) != 0 ? Style::bar : Style::lines;
    interval   = style == Style::bar ? 0.1 : 5.;
    wall_start = wall_last = clock();
  }

  void Progress::update(const unsigned int new_step,
                        const double       new_time,
                        const double       new_time_step,
                        const std::string &new_state)
  {
    if (style == Style::silent)
      return;
    step      = new_step;
    time      = new_time;
    time_step = new_time_step;
    state     = new_state;
    is_shown  = false;
    if (clock() - wall_last >= interval)
      show();
  }

  void Progress::note(const std::string &text)
  {
    if (style == Style::silent)
      return;
    out << (style == Style::bar ? "\r\033[K" : "") << text << std::endl;
    if (style == Style::bar && wall_last != wall_start)
      show();
  }

  void Progress::finish()
  {
    if (style == Style::silent)
      return;
    if (!is_shown)
      show();
    if (style == Style::bar)
      out << std::endl;
  }

  void Progress::show()
  {
    wall_last                 = clock();
    is_shown                  = true;
    const double      done    = end_time > start_time ? (time - start_time) / (end_time - start_time) : 1.;
    const int         percent = std::clamp(static_cast<int>(100. * done), 0, 100);
    const std::string numbers =
      formatted("%3d %%  step %u  t = %.5g s  dt = %.2e s  left %s", percent, step, time, time_step, left().c_str()) +
      (state.empty() ? "" : "  " + state);
    if (style == Style::bar)
      {
        const int n_marks = percent / 5;
        // a line that wraps could not be drawn over
        const std::string line = "[" + std::string(n_marks, '=') + std::string(20 - n_marks, ' ') + "] " + numbers;
        out << "\r" << line.substr(0, terminal_width() - 1) << "\033[K" << std::flush;
      }
    else
      out << numbers << std::endl;
  }

  std::string Progress::left() const
  {
    return time > start_time
             ? hours_minutes_seconds((wall_last - wall_start) / (time - start_time) * std::max(end_time - time, 0.))
             : "?";
  }
} // namespace alluvium
