#pragma once

#include <alluvium/contacts/ranks/contact_share.h>
#include <alluvium/contacts/search/contact_neighbours.h>

#include <memory>

namespace alluvium::contacts
{
  /**
   * What this rank works on in a contact step: all grains and pairs, or its share of them. Keeps the pairs from step to
   * step.
   */
  class ContactWork
  {
  public:
    ContactGeometry           geometry;
    ContactNeighbours         neighbours;
    std::vector<std::uint8_t> all_touched; // of all grains: had a contact impulse in the last step

    /** Collective. */
    void           set_communicator(MPI_Comm communicator);
    unsigned int   n_ranks() const { return share ? share->n_ranks() : 1; }
    ContactTraffic traffic() const { return share ? share->traffic() : ContactTraffic(); }

    /** Start a step of @p all grains, the same on all ranks; with @p sharing, each rank does a part. Collective. */
    void begin(grains::GrainArrays &all, const grains::GrainLoads &all_loads, bool sharing);

    /** End it: all ranks know of all grains again. Collective. */
    void end();

    grains::GrainArrays       &grains() { return shared ? share->grains : *all; } // own, then ghosts
    const grains::GrainLoads  &loads() const { return shared ? share->loads : *all_loads; }
    std::vector<std::uint8_t> &touched() { return shared ? share->touched : all_touched; }
    std::size_t                n_owned() const { return shared ? share->n_owned() : all->n(); }
    std::size_t                n_all() const { return all->n(); }
    bool                       is_shared() const { return shared; }
    ContactCommunicator       *communicator() const { return shared ? &share->exchange() : nullptr; }

    /** Grains have moved. */
    void update_ghosts();

    /** Whether the pairs are those of the present grains on all ranks. Collective. */
    bool known();

    /** See ContactNeighbours. Collective. */
    double slack();

    /**
     * Find all pairs with gaps below @p skin [m]. If ranks share the work, this also decides anew who owns what:
     * grains() and loads() are others then. Collective.
     */
    void search(double skin);

    /** The same in the midst of a solve: the velocities @p discs go along with the grains. */
    void search(double skin, std::vector<Disc> &discs);

    /** Let the next step begin with the pairs of @p last, before which set_archive() has given their impulses. */
    void repeat_search(ContactSearchRecord last) { to_repeat = std::move(last); }
    /** Do so, if that was asked for. Collective. */
    void repeat_search(grains::GrainArrays &all, const grains::GrainLoads &all_loads, bool sharing);

    /** What repeat_search() needs to know of the present pairs. */
    ContactSearchRecord last_search() const { return to_repeat.known ? to_repeat : neighbours.last_search(); }

    /** Whether the pairs are still those of @p grains, all of them. */
    bool fits(const grains::GrainArrays &grains) const
    {
      return shared ? share->fits(grains) && neighbours.known(share->grains) : neighbours.known(grains);
    }

    ContactArchive archive() const { return shared ? share->collect(neighbours.archive()) : neighbours.archive(); }

  private:
    std::unique_ptr<ContactShare> share; // none on one rank

    grains::GrainArrays      *all       = nullptr;
    const grains::GrainLoads *all_loads = nullptr;
    bool                      shared    = false;

    ContactSearchRecord to_repeat;

    void set_shared(bool now);
  };
} // namespace alluvium::contacts
