#pragma once

#include <alluvium/contacts/contact_report.h>
#include <alluvium/contacts/laws/contact_material.h>
#include <alluvium/contacts/search/contact_neighbours.h>
#include <alluvium/contacts/search/contact_search.h>

#include <cstdint>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::contacts
{
  /**
   * Soft spheres (Cundall and Strack): grains overlap, and springs with dashpots push them apart. For comparison with
   * the non-smooth contacts, and with other programs.
   *
   *   f_n = k delta + c v_n             c = -2 ln e sqrt(m k) / sqrt(pi^2 + ln^2 e)         1 / m = 1 / m_i + 1 / m_j
   *   |f_t| <= mu f_n                   of a tangential spring k_t with dashpot c_t, which slides along where it slips
   *
   * Velocity Verlet with sub-steps of a fraction of the shortest collision pi / sqrt(k / m - (c / 2 m)^2); the drag of
   * the loads is implicit. As f_n may pull at the end of a bounce, the coefficient of restitution is e. Friction
   * coefficients are those of the non-smooth contacts; rolling friction and cohesion are not in this model.
   */
  class SoftSpheres
  {
  public:
    /** Declare section `Soft spheres` in the current one of @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * As ContactStepper::advance(). The pairs of @p neighbours keep the normal force [N/m] as rn and the tangential
     * spring's length [m] as rt. Sets @p touched.
     */
    ContactReport advance(grains::GrainArrays       &grains,
                          const grains::GrainLoads  &loads,
                          double                     dt,
                          const ContactMaterials    &materials,
                          bool                       rotation,
                          double                     skin,
                          ContactGeometry           &geometry,
                          ContactNeighbours         &neighbours,
                          std::vector<std::uint8_t> &touched);

    /** What the tangential spring of @p pair carries [N/m]; its dashpot is left out. */
    double spring_force(const ContactPair &pair) const { return -tangential_ratio * stiffness * pair.rt; }

    /** What the springs of @p pairs hold [J/m]. Grains and walls are where they were when the pairs were last used. */
    double spring_energy(const grains::GrainArrays &grains,
                         const ContactGeometry     &geometry,
                         const ContactCandidates   &pairs) const;

    double       stiffness = 1e5, tangential_ratio = 2. / 7., restitution = 0.5;
    unsigned int steps_per_collision = 50;

  private:
    struct Forces
    {
      std::vector<double>                fx, fy, moment;  // on the grains [N/m], [N]
      std::vector<std::array<double, 2>> wall;            // on the wall segments [N/m]
      double                             wall_power = 0.; // of walls on grains [W/m]
    };

    void   find_forces(const grains::GrainArrays &grains,
                       const ContactMaterials    &materials,
                       const ContactGeometry     &geometry,
                       double                     h,
                       ContactCandidates         &pairs,
                       Forces                    &forces) const;
    double collision_time(const grains::GrainArrays &grains) const;
    double damping(double mass, double k) const;

    Forces before, after;
  };
} // namespace alluvium::contacts
