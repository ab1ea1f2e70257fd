#pragma once

#include <mpi.h>

#include <iosfwd>
#include <map>
#include <string>

namespace alluvium
{
  /** Seconds on the wall since some time in the past, by a clock that nobody sets. */
  double wall_seconds();

  /** Where the time goes: wall and CPU seconds by phase, summed over the run. A phase inside another counts in both. */
  class Timers
  {
  public:
    struct Phase
    {
      double        wall = 0., cpu = 0.; // [s]
      unsigned long calls = 0;
    };

    /** Adds to its phase from here to the end of its life. */
    class Scope
    {
    public:
      explicit Scope(Phase &phase);
      ~Scope();
      Scope(const Scope &)            = delete;
      Scope &operator=(const Scope &) = delete;

    private:
      Phase       &phase;
      const double wall_start, cpu_start;
    };

    /** `const auto timer = timers.scope("contacts");` */
    [[nodiscard]] Scope scope(const std::string &phase) { return Scope(phases[phase]); }

    /** Add the phases of @p others. */
    void add(const Timers &others);

    const std::map<std::string, Phase> &all() const { return phases; }

    /** Each phase of the rank that took longest for it, on every rank. Collective. */
    std::map<std::string, Phase> slowest(MPI_Comm communicator) const;

  private:
    std::map<std::string, Phase> phases; // a map: references to its elements stay good
  };

  /** A table, the dearest phase first, with shares of @p total wall seconds. A name `a: b` tells of a part of phase a.
   */
  void print_timers(std::ostream &out, const std::map<std::string, Timers::Phase> &phases, double total);
} // namespace alluvium
