#pragma once

#include <alluvium/grains/contact_bodies.h>
#include <alluvium/grains/contact_material.h>
#include <alluvium/grains/contact_neighbours.h>

#include <array>
#include <cstdint>
#include <vector>

namespace alluvium::grains
{
  /** The lengths and speeds that decide which pairs take part in a sub-step, and how overlaps open. */
  struct ContactMargins
  {
    std::array<double, 2> start_speeds{};  // the two largest of all grains at its start [m/s]
    double                mean_speed = 0.; // and the root mean square of all
    double                wall_speed = 0.; // of the fastest wall

    double h          = 0.;    // length of the sub-step [s]
    double base_h     = 0.;    // and of an unhalved one
    double delta      = 0.;    // gaps and overlaps below this count as closed [m]
    double nearness   = 0.;    // pairs this near take part, whether they approach or not [m]
    double push_out   = 0.;    // overlaps open at most this fast [m/s], and
    double correction = 0.;    // this part of them in one unhalved sub-step
    double threshold  = 0.;    // impacts slower than this do not bounce [m/s]
    bool   gentle     = false; // overlaps do not open at all, and nothing bounces
  };

  /**
   * The pairs that take part in a sub-step: those that touch, are near, or would pass each other without contact. Turns
   * them into the contacts of a ContactProblem and takes their impulses back.
   */
  class ContactActiveSet
  {
  public:
    /** Choose them. With @p keep, those that took part before stay, whatever they do. */
    void select(const GrainArrays      &grains,
                const ContactBodies    &bodies,
                const ContactGeometry  &geometry,
                const ContactMaterials &materials,
                const ContactMargins   &margins,
                bool                    keep,
                ContactCandidates      &candidates);

    /** After a new search: the pairs with an impulse take part, and no others. */
    void restart_from_impulses(const ContactCandidates &candidates);

    /**
     * Let those take part in the next select() that overlap at the end of the sub-step with velocities @p velocity;
     * whether there are any on this rank.
     */
    bool add_violated(const GrainArrays       &grains,
                      const ContactBodies     &bodies,
                      const ContactGeometry   &geometry,
                      const std::vector<Disc> &velocity,
                      double                   h,
                      const ContactCandidates &candidates);

    /**
     * Write the contacts of @p problem, warm impulses included, in the order of their pairs' @p n_colours colours.
     * Collective over the problem's communicator.
     */
    void build(unsigned int            n_colours,
               const GrainArrays      &grains,
               const ContactBodies    &bodies,
               const ContactGeometry  &geometry,
               const ContactMaterials &materials,
               ContactProblem         &problem);

    /** Hand the impulses of the solved @p problem to the pairs. */
    void take_impulses(const ContactProblem &problem);

    /**
     * Whether this is a heap, not a few that met, of which most contacts start without an impulse. There are @p n_discs
     * on all ranks. Collective.
     */
    bool is_cold(double delta, std::size_t n_discs, const ContactProblem &problem) const;

    /** Wall segment of contact @p k of the problem, or -1 if it is between grains. */
    std::int64_t wall_of(const std::size_t k) const { return sorted[k].wall ? std::int64_t(sorted[k].pair->j) : -1; }

    /** Mean and largest overlap of the contacts of @p problem, with the grains where they are now [m]. Collective. */
    void measure_overlaps(const GrainArrays     &grains,
                          const ContactGeometry &geometry,
                          const ContactProblem  &problem,
                          double                &mean,
                          double                &largest) const;

  private:
    struct Active
    {
      ContactPair *pair;
      ContactPoint point;
      double       bias;
      bool         wall;
    };
    std::vector<Active>       active, sorted; // as selected, and by colour as in the problem
    std::vector<std::uint8_t> disc_takes_part, wall_takes_part;
  };
} // namespace alluvium::grains
