#pragma once

#include <alluvium/grains/cohesion.h>
#include <alluvium/grains/contact_force.h>
#include <alluvium/grains/contact_work.h>
#include <alluvium/grains/soft_spheres.h>

namespace alluvium::grains
{
  /**
   * The forces of all contacts of @p grains, by the impulses of the last sub-step that the pairs of @p work know, or,
   * with @p soft_spheres (else null), by their springs. @p cohesion, if not null, is included. Empty if the pairs are
   * not those of these grains. Collective.
   */
  std::vector<ContactForce> list_contact_forces(const ContactWork &work,
                                                const GrainArrays &grains,
                                                const SoftSpheres *soft_spheres,
                                                const Cohesion    *cohesion);
} // namespace alluvium::grains
