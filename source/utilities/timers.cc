#include <alluvium/utilities/timers.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <ostream>
#include <tuple>
#include <vector>

namespace alluvium
{
  namespace
  {
    double seconds(const clockid_t clock)
    {
      timespec now;
      clock_gettime(clock, &now);
      return now.tv_sec + 1e-9 * now.tv_nsec;
    }
  } // namespace

  double wall_seconds()
  {
    return seconds(CLOCK_MONOTONIC);
  }

  Timers::Scope::Scope(Phase &phase)
    : phase(phase)
    , wall_start(wall_seconds())
    , cpu_start(seconds(CLOCK_PROCESS_CPUTIME_ID))
  {}

  Timers::Scope::~Scope()
  {
    phase.wall += wall_seconds() - wall_start;
    phase.cpu += seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_start;
    ++phase.calls;
  }

  std::map<std::string, Timers::Phase> Timers::slowest(MPI_Comm communicator) const
  {
    using Row = std::tuple<std::string, double, double, unsigned long>;
    std::vector<Row> rows;
    for (const auto &[name, phase] : phases)
      rows.emplace_back(name, phase.wall, phase.cpu, phase.calls);

    // By name, since a rank may never have entered some phase.
    std::map<std::string, Phase> result;
    for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator, rows))
      for (const auto &[name, wall, cpu, calls] : of_rank)
        {
          Phase &phase = result[name];
          phase.wall   = std::max(phase.wall, wall);
          phase.cpu    = std::max(phase.cpu, cpu);
          phase.calls  = std::max(phase.calls, calls);
        }
    return result;
  }

  void Timers::add(const Timers &others)
  {
    for (const auto &[name, other] : others.phases)
      {
        Phase &phase = phases[name];
        phase.wall += other.wall;
        phase.cpu += other.cpu;
        phase.calls += other.calls;
      }
  }

  void print_timers(std::ostream &out, const std::map<std::string, Timers::Phase> &phases, const double total)
  {
    std::vector<std::pair<std::string, Timers::Phase>> sorted(phases.begin(), phases.end());
    std::stable_sort(
      sorted.begin(), sorted.end(), [](const auto &a, const auto &b) { return a.second.wall > b.second.wall; });
    std::size_t width = 5;
    for (const auto &[name, phase] : sorted)
      width = std::max(width, name.size());

    char line[300];
    std::snprintf(
      line, sizeof(line), "%-*s %10s %10s %7s %9s\n", int(width), "phase", "wall [s]", "CPU [s]", "share", "calls");
    out << line;
    for (const auto &[name, phase] : sorted)
      {
        std::snprintf(line,
                      sizeof(line),
                      "%-*s %10.3f %10.3f %5.1f %% %9lu\n",
                      int(width),
                      name.c_str(),
                      phase.wall,
                      phase.cpu,
                      total > 0 ? 100. * phase.wall / total : 0.,
                      phase.calls);
        out << line;
      }
  }
} // namespace alluvium
