#pragma once

// The force on a disc that is dragged across cells at constant velocity, and how smooth it is.
#include "moving_grain.h"

namespace moving_grain
{
  /** The disc in vortices of 16 d that do not yield, with the pressure gradient that turns them; a wave of that size.
   */
  inline Smoothness in_given_flow(const bed::Settings &s, const double step, const double length)
  {
    const double               size = 16. * d, k = numbers::PI / size, u = 2. * speed, gamma = 5e5;
    bed::Channel               channel(size, size, s.h_over_d * d, s, 0.);
    bed::coupling::OverlapMap  map(channel.space);
    bed::grains::GrainArrays   grain = dragged_grain(size);
    const std::vector<uint8_t> touched(1, 0);
    auto                       field = channel.space.make_field();
    for (const auto &cell : channel.space.cells())
      for (unsigned int v = 0; v < channel.space.n_nodes_per_cell(); ++v)
        {
          const double x = k * cell.vertex[v][0], y = k * cell.vertex[v][1];
          field.block(0).local_element(cell.velocity[v][0]) = u * std::sin(x) * std::cos(y);
          field.block(0).local_element(cell.velocity[v][1]) = -u * std::cos(x) * std::sin(y);
          field.block(1).local_element(cell.pressure[v])    = gamma * u / k * std::cos(x) * std::sin(y);
        }
    map.reinit();
    std::vector<Tensor<1, 2>> force;
    for (unsigned int i = 0; i < length / step; ++i)
      {
        map.cut(grain, channel.coupling.settings);
        std::vector<bed::coupling::PieceField> at_pieces;
        bed::coupling::evaluate(map, channel.space, field, at_pieces);
        Tensor<1, 2> f;
        for (std::size_t p = 0; p < at_pieces.size(); ++p)
          for (unsigned int c = 0; c < 2; ++c)
            f[c] += map.terms().shape[p].area *
                    (gamma * (at_pieces[p].u[c] - (c == 0 ? grain.velocity[0][0] : grain.velocity[1][0])) -
                     at_pieces[p].grad_p[c]);
        force.push_back(f);
        grain.position[0][0] += step * d * std::cos(angle);
        grain.position[1][0] += step * d * std::sin(angle);
      }
    return smoothness(force);
  }

  inline Smoothness dragged(const bed::Settings &s, const double step, const double length, const double v = speed)
  {
    Box box(s, step, v);
    return smoothness(drag_along(box, step, length));
  }
} // namespace moving_grain
