#pragma once

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  /**
   * Proportional-integral control of the length of steps: how much longer or shorter the next one may be, from the
   * errors of this step and the one before, both over what is asked for. The error of a step is taken to grow with the
   * square of its length, as that of a first-order scheme does (Hairer and Wanner, Solving Ordinary Differential
   * Equations II, section IV.2).
   */
  class PiController
  {
  public:
    /** After a step of @p error that was accepted: the next one's length over its own. */
    double accepted(const double error)
    {
      const double e      = std::max(error, least_error);
      const double factor = safety * std::pow(1. / e, integral) * std::pow(previous / e, proportional);
      previous            = e;
      return std::clamp(factor, least_factor, largest_factor);
    }

    /** The same for the repetition of a step that was taken back; the error need not be finite. */
    static double taken_back(const double error)
    {
      return error < 1e10 ? std::clamp(safety / std::sqrt(error), least_factor, 0.7) : least_factor;
    }

    double previous_error() const { return previous; }
    void   set_previous_error(const double error) { previous = error; }

    static constexpr double largest_factor = 2., least_factor = 0.2;

  private:
    static constexpr double order = 2., integral = 0.5 / order, proportional = 0.3 / order, safety = 0.9,
                            least_error = 1e-4;
    double previous                     = 1.;
  };
} // namespace alluvium::run
