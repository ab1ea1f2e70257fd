#include <alluvium/run/model.h>
#include <alluvium/run/scene_numbers.h>
#include <alluvium/run/slow_run.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/pace.h>

#include <sstream>

namespace alluvium::run
{
  void watch_pace(const Model &model, Pace &pace)
  {
    if (!model.is_root || !pace.falls_behind(model.time))
      return;
    const auto count = [&](const char *name) {
      const auto found = model.counts.find(name);
      return found == model.counts.end() ? 0. : found->second / model.n_steps;
    };
    const auto wall = [&](const char *phase) {
      const auto found = model.timers.all().find(phase);
      return found == model.timers.all().end() ? 0. : found->second.wall;
    };
    std::ostringstream text;
    text << "this run will take " << duration_in_words(pace.duration()) << " at its present pace, not "
         << duration_in_words(pace.expected()) << " as its report expected: steps of " << in_digits(model.time_step)
         << " s, so far with ";
    if (wall("contacts") > wall("fluid"))
      text << in_digits(count("contact sub-steps")) << " contact sub-steps and " << in_digits(count("contact sweeps"))
           << " sweeps in a step. Grains that are to move far in a step need many of them. See Time/Time step and "
              "Contacts.";
    else
      text << in_digits(count("linear iterations")) << " linear iterations in a step"
           << (count("linear solves by the direct solver") > 0. ? ", and direct solves" : "")
           << ". See Time/Time step and Mesh refinement.";
    model.warnings.print(text.str());
  }
} // namespace alluvium::run
