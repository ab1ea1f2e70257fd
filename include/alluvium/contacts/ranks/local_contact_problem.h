#pragma once

#include <alluvium/contacts/ranks/contact_subdomain.h>
#include <alluvium/contacts/search/contact_neighbours.h>

#include <memory>

namespace alluvium::contacts
{
  /**
   * What this rank works on in a contact step: all grains and pairs, or those of its subdomain. Keeps the pairs from
   * step to step.
   */
  class LocalContactProblem
  {
  public:
    ContactGeometry           geometry;
    ContactNeighbours         neighbours;
    std::vector<std::uint8_t> all_touched; // of all grains: had a contact impulse in the last step

    /** Collective. */
    void           set_communicator(MPI_Comm communicator);
    unsigned int   n_ranks() const { return subdomain ? subdomain->n_ranks() : 1; }
    ContactTraffic traffic() const { return subdomain ? subdomain->traffic() : ContactTraffic(); }

    /** Start a step of @p all grains, the same on all ranks; with @p in_subdomains, each rank does a part. Collective.
     */
    void begin(grains::GrainArrays &all, const grains::GrainLoads &all_loads, bool in_subdomains);

    /** End it: all ranks know of all grains again. Collective. */
    void end();

    grains::GrainArrays       &grains() { return partitioned ? subdomain->grains : *all; } // own, then ghosts
    const grains::GrainLoads  &loads() const { return partitioned ? subdomain->loads : *all_loads; }
    std::vector<std::uint8_t> &touched() { return partitioned ? subdomain->touched : all_touched; }
    std::size_t                n_owned() const { return partitioned ? subdomain->n_owned() : all->n(); }
    std::size_t                n_all() const { return all->n(); }
    bool                       is_partitioned() const { return partitioned; }
    ContactCommunicator       *communicator() const { return partitioned ? &subdomain->exchange() : nullptr; }

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
    void repeat_search(grains::GrainArrays &all, const grains::GrainLoads &all_loads, bool in_subdomains);

    /** What repeat_search() needs to know of the present pairs. */
    ContactSearchRecord last_search() const { return to_repeat.known ? to_repeat : neighbours.last_search(); }

    /** Whether the pairs are still those of @p grains, all of them. */
    bool fits(const grains::GrainArrays &grains) const
    {
      return partitioned ? subdomain->fits(grains) && neighbours.known(subdomain->grains) : neighbours.known(grains);
    }

    ContactArchive archive() const
    {
      return partitioned ? subdomain->collect(neighbours.archive()) : neighbours.archive();
    }

  private:
    std::unique_ptr<ContactSubdomain> subdomain; // none on one rank

    grains::GrainArrays      *all         = nullptr;
    const grains::GrainLoads *all_loads   = nullptr;
    bool                      partitioned = false;

    ContactSearchRecord to_repeat;

    void set_partitioned(bool now);
  };
} // namespace alluvium::contacts
