#pragma once

// A disc that is dragged through water at rest, whatever the water does: what it feels from step to step.
#include "bed.h"

namespace moving_grain
{
  using namespace dealii;

  constexpr double d = 2e-4, speed = 5e-3, angle = 0.3; // Re = 1; slanted, not to follow lines of the mesh

  /** Left of the middle of a box of @p size. */
  inline bed::grains::GrainArrays dragged_grain(const double size, const double v = speed)
  {
    bed::grains::GrainArrays grain;
    grain.resize(1);
    grain.position[0][0] = 0.5 * size - 2.93 * d;
    grain.position[1][0] = 0.5 * size - 0.93 * d;
    grain.radius[0] = grain.fluid_radius[0] = 0.5 * d;
    grain.mass[0]                           = 2630. * numbers::PI * d * d / 4.;
    grain.velocity[0][0]                    = v * std::cos(angle);
    grain.velocity[1][0]                    = v * std::sin(angle);
    return grain;
  }

  /** A closed square box of water with one disc, which is dragged along a slanted line. */
  class Box
  {
  public:
    /** @p step: path in a time step over d. */
    Box(const bed::Settings &s, const double step, const double v = speed)
      : channel(size, size, s.h_over_d * d, with_dt(s, step * d / v), 0.)
      , grain(dragged_grain(size, v))
    {
      for (unsigned int id = 0; id < 4; ++id)
        channel.bc.set(id, {boundary_kinds::no_slip, "side " + std::to_string(id), nullptr});
      channel.bc.pin(true);
      channel.initialize();
      channel.solver.linear_solver.tolerance = 1e-10;
    }

    /** Where the disc is now, it acts for a step; then it moves on. Returns the fluid's force on it [N/m]. */
    Tensor<1, 2> step()
    {
      channel.step(grain, true);
      grain.position[0][0] += channel.settings.dt * grain.velocity[0][0];
      grain.position[1][0] += channel.settings.dt * grain.velocity[1][0];
      const auto  &f = channel.coupling.fluid_force()[0];
      Tensor<1, 2> force;
      force[0] = f[0];
      force[1] = f[1];
      return force;
    }

    static constexpr double  size = 16. * d;
    bed::Channel             channel;
    bed::grains::GrainArrays grain;

  private:
    static bed::Settings with_dt(bed::Settings s, const double dt)
    {
      s.dt = dt;
      return s;
    }
  };

  /** How smooth a series of forces is: all over the mean of |force|. */
  struct Smoothness
  {
    double second_difference, rms, range; // largest |F_k+1 - 2 F_k + F_k-1|, its rms, largest less smallest |F|
    double mean;                          // |F| [N/m]
  };

  inline Smoothness smoothness(const std::vector<Tensor<1, 2>> &force)
  {
    Smoothness s{};
    double     low = std::numeric_limits<double>::max(), high = 0.;
    for (const auto &f : force)
      {
        s.mean += f.norm() / force.size();
        low  = std::min(low, f.norm());
        high = std::max(high, f.norm());
      }
    s.range = (high - low) / s.mean;
    for (std::size_t k = 1; k + 1 < force.size(); ++k)
      {
        const double second = (force[k + 1] - 2. * force[k] + force[k - 1]).norm() / s.mean;
        s.second_difference = std::max(s.second_difference, second);
        s.rms += second * second / (force.size() - 2);
      }
    s.rms = std::sqrt(s.rms);
    return s;
  }

  /** Forces on a path of @p length diameters, after one of @p start to forget that it started at once. */
  inline std::vector<Tensor<1, 2>> drag_along(Box &box, const double step, const double length, const double start = 1.)
  {
    std::vector<Tensor<1, 2>> force;
    for (unsigned int k = 0; k < (start + length) / step; ++k)
      {
        const auto f = box.step();
        if (k >= start / step)
          force.push_back(f);
      }
    return force;
  }
} // namespace moving_grain
