#pragma once

#include <alluvium/utilities/constants.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alluvium::grains
{
  using GrainId = std::uint32_t;

  /** One array of numbers per component of a vector. */
  using Components = std::array<std::vector<double>, 2>;

  /**
   * The grains as plain contiguous arrays, sorted by id: what contacts and coupling loop over. GrainStore owns those of
   * a run. SI units, per unit depth; all arrays have n() entries. What a grain has stands once more in `grain_columns`
   * (grain_columns.h), from which files, ranks and pictures follow.
   */
  struct GrainArrays
  {
    std::vector<GrainId> id;
    Components           position;         // of the centre [m]
    std::vector<double>  radius;           // contact radius [m]: what touches
    std::vector<double>  fluid_radius;     // what the fluid sees [m]
    std::vector<double>  mass;             // [kg/m]
    Components           velocity;         // [m/s]
    std::vector<double>  omega;            // [rad/s], anticlockwise
    Components           contact_force;    // mean over the last fluid step [N/m]
    Components           initial_position; // at t = 0 [m]; a periodic box moves it along with the grain

    std::size_t n() const { return id.size(); }

    /** New grains have zeros. */
    void resize(std::size_t size);
  };

  /** Volume of a disc per unit depth [m^2]. */
  inline double disc_volume(const double radius)
  {
    return pi * radius * radius;
  }

  /** Mass of a disc of @p density [kg/m^3], per unit depth [kg/m]. */
  inline double disc_mass(const double density, const double radius)
  {
    return density * pi * radius * radius; // in this order: all results have its round-off
  }

  /** Moment of inertia of a disc about its centre, per unit depth [kg m]. */
  inline double disc_inertia(const double mass, const double radius)
  {
    return 0.5 * mass * radius * radius;
  }

  /**
   * What acts on every grain during one fluid step besides contacts:
   *   (m + added_mass) dv/dt = force - drag * v + contacts,      I domega/dt = torque - spin_drag * omega + contacts.
   * `drag` [N s/m^2] is G = sum over pieces of A gamma, zero where drag was explicit. All arrays have n() entries; the
   * last three are empty where the fluid gives neither added mass nor torque.
   */
  struct GrainLoads
  {
    Components          force; // [N/m]
    std::vector<double> drag;
    std::vector<double> added_mass; // [kg/m]
    std::vector<double> torque;     // [N]
    std::vector<double> spin_drag;  // [N s]

    void reset(const std::size_t size)
    {
      for (auto *v : {&force[0], &force[1], &drag})
        v->assign(size, 0.);
      for (auto *v : {&added_mass, &torque, &spin_drag})
        v->clear();
    }

    double mass_added_to(const std::size_t grain) const { return added_mass.empty() ? 0. : added_mass[grain]; }
  };
} // namespace alluvium::grains
