#pragma once

// What the pressure does when grains cross cell faces.
#include <alluvium/coupling/void_fraction.h>

#include "moving_grain.h"

#include <algorithm>

namespace moving_grain
{
  using Rule = bed::coupling::OverlapSettings::Rule;

  /** How the water learns that grains make room elsewhere: from their velocity, or from the void fraction's rate. */
  enum class Form
  {
    flux,
    rate
  };

  /** -d eps/dt between two fields on a square of n x n cells. */
  class Rate : public Function<2>
  {
  public:
    Rate(const bed::fluid::FluidSpace<2> &space, const double h)
      : space(space)
      , h(h)
      , n(static_cast<unsigned int>(std::round(std::sqrt(space.cells().size()))) + 1)
      , nodal(n * n)
    {}

    void set(const bed::fluid::Vector &eps, const bed::fluid::Vector &old, const double dt)
    {
      for (const auto &cell : space.cells())
        for (unsigned int v = 0; v < 4; ++v)
          {
            const auto i     = static_cast<unsigned int>(std::round(cell.vertex[v][0] / h)),
                       j     = static_cast<unsigned int>(std::round(cell.vertex[v][1] / h));
            nodal[j * n + i] = (old.local_element(cell.node[v]) - eps.local_element(cell.node[v])) / dt;
          }
    }

    double value(const Point<2> &x, const unsigned int = 0) const override
    {
      const auto   i = static_cast<unsigned int>(x[0] / h), j = static_cast<unsigned int>(x[1] / h);
      const double a = x[0] / h - i, b = x[1] / h - j;
      return (1. - b) * ((1. - a) * nodal[j * n + i] + a * nodal[j * n + i + 1]) +
             b * ((1. - a) * nodal[(j + 1) * n + i] + a * nodal[(j + 1) * n + i + 1]);
    }

  private:
    const bed::fluid::FluidSpace<2> &space;
    const double                     h;
    const unsigned int               n;
    std::vector<double>              nodal;
  };

  /** Range of the pressure, largest less smallest, in every step [Pa] of grains that move through a closed box without
   * drag: nothing but the water that they displace. */
  inline std::vector<double>
  pressure_ranges(bed::grains::GrainArrays grains, const bed::Settings &s, const Rule rule, const Form form)
  {
    constexpr double          step = 0.02, length = 4., dt = step * d / speed;
    Box                       box(s, step);
    auto                     &channel = box.channel;
    bed::coupling::OverlapMap map(channel.space);
    map.reinit();
    auto settings    = channel.coupling.settings;
    settings.rule    = rule;
    const double h   = Box::size / std::round(Box::size / (s.h_over_d * d));
    auto         eps = channel.space.make_nodal_field(), old = eps;
    Rate         rate(channel.space, h);

    std::vector<double> range;
    for (unsigned int k = 0; k < (1. + length) / step; ++k)
      {
        map.cut(grains, settings);
        old = eps;
        old.update_ghost_values();
        bed::coupling::lumped_void_fraction(map.terms(), channel.space, eps);
        rate.set(eps, k == 0 ? eps : old, dt);
        for (std::size_t p = 0; p < map.terms().n_pieces(); ++p)
          map.terms().exchange[p].a = {
            {form == Form::flux ? grains.velocity[0][0] : 0., form == Form::flux ? grains.velocity[1][0] : 0.}};
        bed::fluid::VansProblem<2> problem{};
        problem.dt            = dt;
        problem.void_fraction = &eps;
        problem.solid         = &map.terms();
        problem.mass_source   = form == Form::rate ? &rate : nullptr;
        channel.solver.accept();
        channel.solver.begin_step(channel.bc, problem);
        channel.solver.solve();
        const auto &p = channel.solver.solution().block(1);
        if (k * step > 1.)
          range.push_back(*std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end()));
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            grains.position[0][i] += dt * grains.velocity[0][i];
            grains.position[1][i] += dt * grains.velocity[1][i];
          }
      }
    return range;
  }

  /** n x n discs 1.4 d apart, a void fraction of 0.6, that move as one. */
  inline bed::grains::GrainArrays moving_block(const unsigned int n)
  {
    const bed::grains::GrainArrays one = dragged_grain(Box::size);
    bed::grains::GrainArrays       grains;
    grains.resize(n * n);
    for (unsigned int i = 0; i < n * n; ++i)
      {
        grains.id[i]           = i;
        grains.radius[i]       = one.radius[0];
        grains.fluid_radius[i] = one.fluid_radius[0];
        grains.mass[i]         = one.mass[0];
        grains.position[0][i]  = one.position[0][0] + (i % n - 0.5 * (n - 1.)) * 1.4 * d;
        grains.position[1][i]  = one.position[1][0] + (i / n - 0.5 * (n - 1.)) * 1.4 * d;
        grains.velocity[0][i]  = one.velocity[0][0];
        grains.velocity[1][i]  = one.velocity[1][0];
      }
    return grains;
  }

  /** The largest change of the range from a step to the next, over rho (d/dt)^2. */
  inline double spike(const std::vector<double> &range)
  {
    double largest = 0.;
    for (std::size_t k = 1; k < range.size(); ++k)
      largest = std::max(largest, std::abs(range[k] - range[k - 1]));
    constexpr double velocity = speed / 0.02; // d/dt
    return largest / (1000. * velocity * velocity);
  }

  inline bed::Settings settings(const double h, const double filter)
  {
    bed::Settings s;
    s.h_over_d = h;
    s.filter   = filter;
    return s;
  }
} // namespace moving_grain
