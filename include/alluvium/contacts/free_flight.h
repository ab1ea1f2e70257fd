#pragma once

#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/search/contact_search.h>

namespace alluvium::contacts
{
  /**
   * Moves grains that touch nothing, without a contact problem, and knows when two of them, or one and a wall, may
   * meet. It looks for neighbours only when grains may have gone as far as the smallest gap that it knows. Walls stand
   * still.
   */
  class FreeFlight
  {
  public:
    /**
     * Whether nothing can meet in a step of @p dt [s] under @p loads. That depends on the smallest gap there is, not on
     * when it was last measured, so that a restarted run comes to the same answer.
     */
    bool is_safe(const grains::GrainArrays &grains,
                 const grains::GrainLoads  &loads,
                 double                     dt,
                 bool                       rotation,
                 const ContactGeometry     &geometry);

    /** Move @p grains by @p n_substeps sub-steps of @p h [s]: what ContactStepper makes of grains without a contact. */
    void move(grains::GrainArrays      &grains,
              const grains::GrainLoads &loads,
              double                    h,
              unsigned int              n_substeps,
              bool                      rotation,
              const ContactGeometry    &geometry);

    /** Measure the smallest gap anew. */
    void forget() { gap = -1.; }

    /** The smallest gap between two grains, or a grain and a wall [m], or @p largest if that is less. */
    static double smallest_gap(const grains::GrainArrays &grains, const ContactGeometry &geometry, double largest);

  private:
    double        gap = -1.; // the smallest one, at least [m]; negative: not known
    ContactBodies bodies;
  };
} // namespace alluvium::contacts
