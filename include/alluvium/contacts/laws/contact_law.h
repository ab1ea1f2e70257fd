#pragma once

#include <alluvium/contacts/laws/contact_material.h>
#include <alluvium/utilities/plugin_interface.h>

#include <vector>

namespace alluvium::contacts
{
  /** What a law may know of a contact before its sub-step is solved. */
  struct ContactState
  {
    double gap;        // at the start of the sub-step [m]
    double start_vn;   // normal velocity there, negative while they approach [m/s]
    double free_vn;    // and at its end, if there were no contacts
    double slip_speed; // how fast the surfaces slide along each other at its start, spin and belts included [m/s]
  };

  /**
   * Interface of the plug-ins for contact laws: which friction, rolling friction and restitution each contact has in a
   * sub-step. They are asked once a sub-step for all contacts, so that the sweeps pay nothing.
   */
  class ContactLaw : public Plugin
  {
  public:
    /** Whether all contacts have the numbers of their materials, whatever they do; if so, nothing else is asked. */
    virtual bool is_constant() const { return false; }

    /**
     * @p coefficients come as those of the contacts' materials, one for each of @p states, and leave as what counts in
     * this sub-step. Must depend on nothing but the contact itself, or results would depend on the number of ranks.
     * Rolling friction counts only in scenes where a material has some.
     */
    virtual void set_coefficients(const std::vector<ContactState> &states,
                                  std::vector<ContactMaterial>    &coefficients) const = 0;
  };
} // namespace alluvium::contacts
