#pragma once

namespace alluvium
{
  class Pace;

  namespace run
  {
    struct Model;

    /**
     * After a step: the first rank says, once, that the run of @p model takes far longer than its report told, and with
     * what it spends its time. What is said depends on the machine, so no summary keeps it.
     */
    void watch_pace(const Model &model, Pace &pace);
  } // namespace run
} // namespace alluvium
