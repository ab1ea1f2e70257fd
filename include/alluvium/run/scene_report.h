#pragma once

#include <iosfwd>

namespace alluvium::run
{
  struct Model;
  class Output;
  class TimeStepControl;
  class ModelChoice;

  /**
   * What the scene is, room by room, what it leaves out, and what to expect of it; the first rank writes it to
   * @p out. @p end_time of the run [s]. Returns how long it is expected to take [s]. Collective.
   */
  double report_scene(const Model           &model,
                      const Output          &output,
                      const TimeStepControl &control,
                      const ModelChoice     &choice,
                      double                 end_time,
                      std::ostream          &out);
} // namespace alluvium::run
