#pragma once

/**
 * Between what bounds the numbers of a scene are, in SI units. What is outside is a slip of the pen, or meant in other
 * units; and squares and cubes of it may overflow.
 */
namespace alluvium::magnitudes
{
  constexpr double smallest = 1e-30, largest = 1e30; // of any number that is not 0

  constexpr double smallest_length = 1e-9, largest_length = 1e9; // [m]
  constexpr double largest_speed        = 1e9;                   // [m/s]
  constexpr double largest_acceleration = 1e9;                   // [m/s^2]
  constexpr double largest_density      = 1e9;                   // [kg/m^3]
  constexpr double largest_viscosity    = 1e15;                  // dynamic [Pa s]
} // namespace alluvium::magnitudes
