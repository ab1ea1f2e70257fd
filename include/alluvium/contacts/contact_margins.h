#pragma once

#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/solvers/contact_cone.h>

#include <algorithm>

namespace alluvium::contacts
{
  /** The lengths and speeds that decide which pairs take part in a sub-step, and how overlaps open. */
  struct ContactMargins
  {
    GrainSpeeds speeds;          // at the start of the sub-step
    double      wall_speed = 0.; // of the fastest wall [m/s]

    double h                   = 0.;    // length of the sub-step [s]
    double base_h              = 0.;    // and of an unhalved one
    double delta               = 0.;    // gaps and overlaps below this count as closed [m]
    double alert_distance      = 0.;    // pairs this near take part, whether they approach or not [m]
    double depenetration_speed = 0.;    // overlaps open at most this fast [m/s], and
    double correction          = 0.;    // this part of them in one unhalved sub-step
    double threshold           = 0.;    // impacts slower than this do not bounce [m/s]
    bool   inelastic           = false; // overlaps do not open at all, and nothing bounces

    /**
     * The bias of contacts with v_n + bias >= 0 at the end, for one gap or several: gaps within delta count as closed,
     * so that a bed at rest does not chatter; overlaps open at bounded speed.
     */
    template <typename T>
    ALLUVIUM_INLINE T bias(const T &gap) const
    {
      // No branch: nobody can predict which contacts are open.
      const T none{};
      T       closing = (gap - delta) / h, opening = correction * (gap + delta) / base_h;
      raise_to(opening, none - depenetration_speed);
      opening = gap < none - delta ? opening : none;
      return gap > none + delta ? closing : (inelastic ? none : opening);
    }

    /** That of a contact with @p restitution, if it has the bias @p b without. Velocities as in ContactState. */
    double bounce(
      const double b, const double gap, const double start_vn, const double free_vn, const double restitution) const
    {
      if (restitution > 0. && !inelastic && start_vn < -threshold && gap + h * free_vn < delta)
        return gap > 0. ? restitution * start_vn : std::min(b, restitution * start_vn);
      return b;
    }
  };
} // namespace alluvium::contacts
