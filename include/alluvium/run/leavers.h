#pragma once

namespace alluvium::run
{
  struct Model;

  /** Count the grains that are outside the domain at the end of a step. */
  void count_leavers(Model &model);

  /** Take the grains that are outside the domain out of the model, before a step; returns whether any were. Collective.
   */
  bool remove_leavers(Model &model);
} // namespace alluvium::run
