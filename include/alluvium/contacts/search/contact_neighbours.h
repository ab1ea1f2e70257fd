#pragma once

#include <alluvium/contacts/search/contact_archive.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/contacts/solvers/contact_communicator.h>

#include <vector>

namespace alluvium::contacts
{
  /** What the last search saw, and how far it still serves: enough to repeat it, to the bit. */
  struct ContactSearchRecord
  {
    bool                known = false;        // whether there was one whose pairs are still in use
    std::vector<double> x, y, wall_positions; // of all grains, and as in ContactArchive [m]
    double              skin = 0., left = 0.; // then, and less what walls have moved since [m]
  };

  /**
   * The pairs that the last contact search found, with the impulses they last exchanged. Knows how far grains may still
   * move before it misses a pair, and carries the impulses of pairs over to the next search by the ids of their grains.
   */
  class ContactNeighbours
  {
  public:
    ContactCandidates pairs;         // by colour, and by grains (i, j) in each
    unsigned int      n_colours = 0; // of the pairs

    /** Search anew all pairs with gaps below @p skin [m]; known pairs keep their impulses. */
    void search(const grains::GrainArrays &grains, const ContactGeometry &geometry, double skin);

    /**
     * After a search of all grains, go on with one rank's @p share of the pairs, between its @p grains only, of which
     * it owns the first @p n_owned.
     */
    void keep(ContactCandidates share, const grains::GrainArrays &grains, std::size_t n_owned);

    ContactSearchRecord last_search() const;

    /** Search as @p last did: @p grains and walls are where they were. The impulses are those of set_archive(). */
    void repeat(const ContactSearchRecord &last, const grains::GrainArrays &grains, const ContactGeometry &geometry);

    /** Let the next use search anew, whatever has moved. */
    void forget();

    /** Whether there was a search, and for these grains in this order. */
    bool known(const grains::GrainArrays &grains) const { return searched && searched_id == grains.id; }

    /**
     * How far two grains, or a grain and a wall, may still approach each other before a pair is missed [m]. Collective
     * over @p communicator, if there are several ranks.
     */
    double slack(const grains::GrainArrays &grains,
                 const grains::Periodicity &periodicity,
                 ContactCommunicator       *communicator = nullptr) const;

    /** Walls have moved by up to @p distance [m]. */
    void walls_moved(const double distance) { skin -= distance; }

    /** The length of the sub-step that the impulses are of [s]. */
    double substep() const { return warm_dt; }

    /** Make the impulses those of a sub-step of length @p h [s]. */
    void rescale(double h);

    /** Forget the impulses of the pairs. */
    void drop_impulses()
    {
      for (auto *list : {&pairs.discs, &pairs.walls})
        for (ContactPair &p : *list)
          p.rn = p.rt = 0.;
    }

    /** Of the pairs whose first grain this rank owns; by grains (i, j) if they are not a share. */
    ContactArchive archive() const;
    void           set_archive(ContactArchive archive);

  private:
    std::vector<grains::GrainId> searched_id; // the grains of the last search, and where they were
    std::vector<double>          searched_x, searched_y;
    std::size_t                  n_owned = 0; // of them
    double                       skin    = 0.;
    ContactSearchRecord          record; // of all grains, also where this is a share
    bool                         searched = false;
    ContactArchive               pending;                // impulses that wait for a search, sorted
    std::vector<std::uint32_t>   disc_order, wall_order; // the pairs by grains (i, j); empty for a share
    double                       warm_dt = 0.;

    void set_pending(ContactArchive archive);
    void carry(const grains::GrainArrays &grains, std::vector<ContactPair> &found, bool wall) const;
    void add_to(ContactArchive &archive, bool wall) const;
  };
} // namespace alluvium::contacts
