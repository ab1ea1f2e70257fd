#pragma once

#include <alluvium/contacts/contact_active_set.h>
#include <alluvium/contacts/contact_bonds.h>
#include <alluvium/contacts/ranks/local_contact_problem.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** Moves grains with the impulses of a solved sub-step, and keeps account of what they and the walls got. */
  class ContactMotion
  {
  public:
    /** Start a step. */
    void reset(std::size_t n_walls) { on_wall.assign(n_walls, {{0., 0., 0.}}); }

    /**
     * Final velocities from the impulses of @p problem themselves, so that momentum is balanced to round-off; positions
     * from them; the grains' contact_force gets the impulses added. Returns how many contacts of this rank carry
     * something. Collective.
     */
    unsigned int move(const ContactProblem   &problem,
                      const ContactActiveSet &active,
                      const ContactBodies    &bodies,
                      const ContactBonds     &bonds,
                      double                  h,
                      bool                    rotation,
                      LocalContactProblem    &local);

    /** What each wall segment got in the step up to now [N s/m], and the work that it did [J/m]. */
    const std::vector<std::array<double, 3>> &wall_impulses() const { return on_wall; }

  private:
    struct WallImpulse
    {
      std::size_t           wall;
      std::array<double, 3> impulse; // and work
    };

    /** On a grain in a sub-step, over the radius what turns it [N s/m]. */
    struct alignas(32) Impulse
    {
      double x = 0., y = 0., spin = 0., none = 0.;
    };
    std::vector<std::array<double, 3>> on_wall;
    std::vector<WallImpulse>           from_contacts; // of a sub-step
    std::vector<Impulse>               on_grain;

    void add_wall_impulses(ContactCommunicator *communicator);
  };
} // namespace alluvium::contacts
