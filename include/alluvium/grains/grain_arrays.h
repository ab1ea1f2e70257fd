#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alluvium::grains
{
  using GrainId = std::uint32_t;

  /**
   * The grains as plain contiguous arrays, sorted by id: what the contact solver and the coupling loop over. The
   * persistent owner is GrainStore (deal.II's ParticleHandler), which gathers into this once a fluid step and scatters
   * back. SI units, per unit depth; all vectors have n() entries.
   */
  struct GrainArrays
  {
    std::vector<GrainId> id;
    std::vector<double>  x, y;         // centre [m]
    std::vector<double>  radius;       // contact radius [m]: what touches
    std::vector<double>  fluid_radius; // what the fluid sees [m]
    std::vector<double>  mass;         // [kg/m]
    std::vector<double>  vx, vy;       // [m/s]
    std::vector<double>  omega;        // [rad/s], anticlockwise
    std::vector<double>  fcx, fcy;     // mean contact force over the last fluid step [N/m]
    std::vector<double>  x0, y0;       // where the grain was at t = 0 [m]

    std::size_t n() const { return x.size(); }

    void resize(const std::size_t size)
    {
      id.resize(size);
      for (auto *v : {&x, &y, &radius, &fluid_radius, &mass, &vx, &vy, &omega, &fcx, &fcy, &x0, &y0})
        v->resize(size, 0.);
    }
  };

  /** Moment of inertia of a disc about its centre, per unit depth [kg m]. */
  inline double disc_inertia(const double mass, const double radius)
  {
    return 0.5 * mass * radius * radius;
  }

  /**
   * What acts on every grain during one fluid step besides contacts:
   *   (m + added_mass) dv/dt = force - drag * v + contacts,      I domega/dt = torque - spin_drag * omega + contacts.
   * `drag` [N s/m^2] is G = sum over pieces of A gamma, zero where drag was explicit. All vectors have n() entries; the
   * last three are empty where the fluid gives neither added mass nor torque.
   */
  struct GrainLoads
  {
    std::vector<double> fx, fy; // [N/m]
    std::vector<double> drag;
    std::vector<double> added_mass; // [kg/m]
    std::vector<double> torque;     // [N]
    std::vector<double> spin_drag;  // [N s]

    void reset(const std::size_t size)
    {
      for (auto *v : {&fx, &fy, &drag})
        v->assign(size, 0.);
      for (auto *v : {&added_mass, &torque, &spin_drag})
        v->clear();
    }

    double mass_added_to(const std::size_t grain) const { return added_mass.empty() ? 0. : added_mass[grain]; }
  };
} // namespace alluvium::grains
