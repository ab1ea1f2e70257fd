#pragma once

#include <functional>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /**
   * Times in (@p from, @p to) at which @p f of time jumps or has a kink, in ascending order, each the last time that
   * belongs to what is before. Found by bisection wherever second differences of many samples do not fall as those of
   * a smooth function do; of two that are nearer to one another than the samples (the ten thousandth part of the
   * interval), only one may be seen. Empty for a function with hundreds of them: no step can wait for each.
   */
  std::vector<double> find_kinks(const std::function<double(double)> &f, double from, double to);

  /**
   * The kinks until @p end_time [s] of all that a scene gives as a function of time: boundary values, body force,
   * walls. Steps are to end there. They do not depend on where a restart goes on.
   */
  std::vector<double> given_kinks(const Model &model, double end_time);
} // namespace alluvium::run
