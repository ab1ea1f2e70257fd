#pragma once

namespace alluvium::run
{
  struct Model;

  /**
   * The longest step that the time scheme stands in linear theory with the grains as they are [s], see
   * doc/theory/coupling.md: infinite where it has no limit, 0 where it is unstable at any. Collective.
   */
  double stable_step(const Model &model, double end_time);

  /** Warn of a time step that the scheme does not stand in linear theory, see doc/theory/coupling.md. Collective. */
  void check_time_step(Model &model, double end_time);
} // namespace alluvium::run
