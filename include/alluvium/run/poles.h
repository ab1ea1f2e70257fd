#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /** Where a function of time is no finite number, or goes beyond all bounds. */
  struct Pole
  {
    double time, value;
  };

  /**
   * The first of @p times, ascending, at which @p f is not finite; or else a time between them near which |f| grows
   * without end. That is looked for by bisection around the largest of neighbouring samples.
   */
  std::optional<Pole> find_pole(const std::function<double(double)> &f, const std::vector<double> &times);

  /**
   * Look at all that the scene gives the fluid as a function of time, until @p end_time [s]: boundary values at some
   * points, what drives it, the wanted size of cells. Throws UserError that names the parameter where one of them has a
   * pole. Leaves boundary values and driving at the model's time.
   */
  void check_poles(Model &model, double end_time);

  /** The same of the velocities of walls, while they move: before contacts are asked to move them. */
  void check_poles_of_walls(const Model &model, double end_time);
} // namespace alluvium::run
