#pragma once

namespace alluvium::run
{
  struct Model;

  /** Warn of a time step that the scheme does not stand in linear theory, see doc/equations.md. Collective. */
  void check_time_step(Model &model, double end_time);
} // namespace alluvium::run
