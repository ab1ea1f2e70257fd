#pragma once

namespace alluvium::run
{
  struct Model;

  /** Warn of walls that do less than one may think: those that move in a fluid, or among grains that are fixed. */
  void check_walls(Model &m, double end_time);
} // namespace alluvium::run
