#pragma once

#include <alluvium/contacts/contact_force.h>
#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/contacts/ranks/local_contact_problem.h>
#include <alluvium/contacts/soft_spheres.h>

namespace alluvium::contacts
{
  /**
   * The forces of all contacts of @p grains, by the impulses of the last sub-step that the pairs of @p work know, or,
   * with @p soft_spheres (else null), by their springs. @p cohesion, if not null, is included. Empty if the pairs are
   * not those of these grains. Collective.
   */
  std::vector<ContactForce> list_contact_forces(const LocalContactProblem &local,
                                                const grains::GrainArrays &grains,
                                                const SoftSpheres         *soft_spheres,
                                                const Cohesion            *cohesion);
} // namespace alluvium::contacts
