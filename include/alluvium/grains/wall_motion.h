#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace alluvium::grains
{
  /** What a wall does in the course of time: phases of motion, whose velocities add up, and when it is there at all. */
  class WallMotion
  {
  public:
    static constexpr double for_ever = std::numeric_limits<double>::infinity();

    /** Velocity in x and y [m/s] and spin [rad/s]. */
    using Velocity = std::array<double, 3>;

    struct Phase
    {
      Velocity                        velocity = {{0., 0., 0.}};
      double                          from = -for_ever, to = for_ever; // [s]
      std::function<Velocity(double)> at_time; // in place of the constant velocity, if it is there
      std::string                     text;    // of its formulas, for messages
    };

    std::vector<Phase> phases;
    double             present_from = -for_ever, present_to = for_ever; // [s]

    /** Mean over the interval from @p t to t + @p h [s]: with it, a wall is where it should be at its end. */
    Velocity mean_velocity(double t, double h) const;

    /** Is there a time at which the wall is not there? */
    bool comes_or_goes() const { return present_from > -for_ever || present_to < for_ever; }

    /** Is the wall there in a (sub-)step that starts at @p t [s]? */
    bool is_present(double t) const;

    /** Does the wall move, appear or vanish between @p t and t + @p h [s]? */
    bool acts(double t, double h) const;

    /** Does it do so at any time? */
    bool ever_acts() const;
  };
} // namespace alluvium::grains
