#pragma once

#include <alluvium/contacts/contact_memory.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::contacts
{
  class ContactStepper;

  /** Grains and contacts before a step that may be taken back: what ContactStepper::advance() changes of them. */
  class StepStart
  {
  public:
    /** Collective. */
    void remember(const grains::GrainArrays &grains, const ContactStepper &contacts);

    /** Put @p grains and @p contacts back to where they were. Collective. */
    void restore(grains::GrainArrays &grains, ContactStepper &contacts) const;

    /** Of the grains then [m/s]. */
    const grains::Components &velocity() const { return before.velocity; }

  private:
    grains::GrainArrays before; // columns that change in a step; the others are empty
    ContactMemory       memory;
  };
} // namespace alluvium::contacts
