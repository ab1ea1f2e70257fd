#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace alluvium::observers
{
  namespace
  {
    /** How long steps are that the program chooses, and why. */
    class TimeStep : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.time_step_choice; }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        for (const auto *name : {"time_step_s", "time_step_limit", "time_steps_taken_back", "stability_margin"})
          statistics.add_column(name);
      }

      void observe(const Snapshot &s) override
      {
        if (s.step == 0)
          return;
        shortest = std::min(shortest, s.dt);
        longest  = std::max(longest, s.dt);
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        if (s.step == 0)
          return;
        statistics.set("time_step_s", s.dt);
        statistics.set("time_step_limit", s.time_step_choice->limit);
        statistics.set("time_steps_taken_back", s.time_step_choice->n_taken_back);
        if (s.time_step_choice->margin > 0.)
          statistics.set("stability_margin", s.time_step_choice->margin);
      }

      void conclude(output::Summary &summary) const override
      {
        if (longest == 0.)
          return;
        summary.set("time step/shortest_s", shortest);
        summary.set("time step/longest_s", longest);
      }

      void save(nlohmann::ordered_json &state) const override { state = {shortest, longest}; }
      void load(const nlohmann::ordered_json &state) override
      {
        shortest = state.at(0);
        longest  = state.at(1);
      }

    private:
      double shortest = std::numeric_limits<double>::max(), longest = 0.; // [s]
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(
    TimeStep,
    "time step",
    "with `Time step = auto`, the length of steps, what kept them from being longer (`fluid` and `grains`: their "
    "errors; `path`: of the grains; `contacts`: they were hard to solve; `stability`: of the time scheme; `growth`: it "
    "was not longer than twice the one before; `largest`: the parameter; `event`: output was due or a given function "
    "had a kink; `start`; `failure`: a longer one was tried), how many were taken back, and the stability limit over "
    "the step where the time scheme has one")
} // namespace alluvium::observers
