#pragma once

#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/contacts/search/contact_search.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** The attraction of cohesion: makes, keeps and breaks the bonds of pairs, and loads the grains with their forces. */
  class ContactBonds
  {
  public:
    /** Start a sub-step of @p n_discs grains and @p n_walls wall segments without any attraction. */
    void reset(std::size_t n_discs, std::size_t n_walls);

    /**
     * Bond all pairs whose gap is at most @p closed [m], and change the free velocities of @p bodies by what all bonds
     * pull in a sub-step of length @p h [s].
     */
    void attract(const grains::GrainArrays &grains,
                 const ContactGeometry     &geometry,
                 const Cohesion            &cohesion,
                 double                     h,
                 double                     closed,
                 ContactCandidates         &candidates,
                 ContactBodies             &bodies);

    /** After a sub-step: pairs with an impulse have touched, and are bonded; bonds that are stretched too far break. */
    static void update(const grains::GrainArrays &grains,
                       const ContactGeometry     &geometry,
                       const Cohesion            &cohesion,
                       ContactCandidates         &candidates);

    /** What bonds pulled at every grain and at every wall segment in the sub-step [N s/m]; empty without cohesion. */
    std::vector<std::array<double, 2>> on_grain, on_wall;
  };
} // namespace alluvium::contacts
