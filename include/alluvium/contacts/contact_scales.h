#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <array>

namespace alluvium::contacts
{
  /** What lengths, masses and speeds of a contact step are small or large against. */
  struct ContactScales
  {
    double                d_min = 0., d_max = 0.; // diameters [m]
    double                mean_mass = 0.; // harmonic: the light grains decide, and fixed ones do not count [kg/m]
    double                mass      = 0.; // of all that move
    double                lightest = 0., heaviest = 0.; // of those that move
    double                g = 0.;                       // [m/s^2]
    std::array<double, 2> down{};                       // unit vector of gravity; zero without
  };

  /** Of @p grains, at least one, under @p gravity [m/s^2]. */
  ContactScales make_scales(const grains::GrainArrays &grains, std::array<double, 2> gravity);

  /**
   * Into how many sub-steps a step of @p dt [s] is cut so that no grain moves by more than @p largest_move [m] in one:
   * from the largest speed, now or at the end if the last step's contact forces go on. Throws a Divergence if
   * something is not finite, or moves so fast that they would be more than a million.
   */
  unsigned int
  count_substeps(const grains::GrainArrays &grains, const grains::GrainLoads &loads, double dt, double largest_move);
} // namespace alluvium::contacts
