#pragma once

#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/contact_margins.h>
#include <alluvium/contacts/laws/contact_law.h>
#include <alluvium/contacts/laws/contact_material.h>
#include <alluvium/contacts/search/contact_neighbours.h>

#include <array>
#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /**
   * The pairs that take part in a sub-step: those that touch, are near, or would pass each other without contact. Turns
   * them into the contacts of a ContactProblem and takes their impulses back.
   */
  class ContactActiveSet
  {
  public:
    /**
     * Choose them, with @p keep also those that took part before, whatever they do, and write them as the contacts of
     * @p problem, warm impulses included. They come in the order of @p candidates, which is by their @p n_colours
     * colours; in each, grains' before walls'. Collective over the problem's communicator.
     */
    void select(const grains::GrainArrays &grains,
                const ContactBodies       &bodies,
                const ContactGeometry     &geometry,
                const ContactMaterials    &materials,
                const ContactMargins      &margins,
                bool                       keep,
                unsigned int               n_colours,
                ContactCandidates         &candidates,
                ContactProblem            &problem);

    /** After a new search: the pairs with an impulse take part, and no others. */
    void restart_from_impulses(const ContactCandidates &candidates);

    /**
     * Let those take part in the next select() that overlap at the end of the sub-step with velocities @p velocity;
     * whether there are any on this rank.
     */
    bool add_violated(const grains::GrainArrays &grains,
                      const ContactBodies       &bodies,
                      const ContactGeometry     &geometry,
                      const std::vector<Disc>   &velocity,
                      double                     h,
                      const ContactCandidates   &candidates);

    /** Hand the impulses of the solved @p problem to the pairs. Returns the largest normal impulse of this rank. */
    double take_impulses(const ContactProblem &problem, ContactCandidates &candidates) const;

    /**
     * Whether this is a heap, not a few that met, of which most contacts started without an impulse. There are
     * @p n_discs on all ranks. Collective.
     */
    bool is_cold(std::size_t n_discs, const ContactProblem &problem) const;

    /** The pair of contact @p k of the problem. */
    const ContactPair &pair(const std::size_t k, const ContactCandidates &candidates) const
    {
      return is_wall(k, candidates) ? candidates.walls[number[k] - candidates.discs.size()]
                                    : candidates.discs[number[k]];
    }
    bool is_wall(const std::size_t k, const ContactCandidates &candidates) const
    {
      return number[k] >= candidates.discs.size();
    }

    /** Mean and largest overlap of the contacts of @p problem, with the grains where they are now [m]. Collective. */
    void measure_overlaps(const grains::GrainArrays &grains,
                          const ContactGeometry     &geometry,
                          const ContactProblem      &problem,
                          const ContactCandidates   &candidates,
                          double                    &mean,
                          double                    &largest);

  private:
    std::vector<std::uint32_t> number; // of each contact's pair; those with walls come after all others
    std::vector<std::uint8_t>  disc_takes_part, wall_takes_part; // of the pairs
    std::size_t                n_closed = 0, n_warm = 0;         // contacts that touch; those of them with an impulse
    std::vector<double>        overlaps;

    // For a law that asks.
    std::vector<ContactState>    states;
    std::vector<ContactMaterial> coefficients;

    void ask(const ContactLaw &law, const ContactMargins &margins, ContactProblem &problem);
  };
} // namespace alluvium::contacts
