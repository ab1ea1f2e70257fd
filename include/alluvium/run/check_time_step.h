#pragma once

namespace alluvium::run
{
  struct Model;

  /**
   * The longest step that the time scheme stands in linear theory with the grains as they are [s], at the void fraction
   * of the densest tenth of them, see doc/theory/coupling.md: infinite where it has no limit, 0 where it is unstable at
   * any. Collective.
   */
  double stable_step(const Model &model);

  /**
   * Warn, once in a run, of a time step that the scheme does not stand in linear theory with the grains as they are,
   * see doc/theory/coupling.md: with the factor by which it is too long, and what would do. Collective.
   */
  void check_time_step(Model &model);

  /** Of the longest step that the scheme stands, what a chosen one may be. */
  constexpr double stable_share = 0.8;

  /**
   * Warn at the start of a run to @p end_time [s] with chosen steps if the scheme makes them so short that they are
   * very many. Collective.
   */
  void check_number_of_steps(Model &model, double end_time);
} // namespace alluvium::run
