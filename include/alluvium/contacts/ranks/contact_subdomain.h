#pragma once

#include <alluvium/contacts/ranks/contact_partition.h>
#include <alluvium/contacts/ranks/ghost_exchange.h>
#include <alluvium/contacts/search/contact_archive.h>

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /**
   * What one rank works on in a contact step: its own grains, then ghosts, with their loads, as arrays like those of
   * all grains but smaller. Between fluid steps and at contact searches all ranks have all grains; in between, each
   * moves its own.
   */
  class ContactSubdomain
  {
  public:
    /** Collective. */
    explicit ContactSubdomain(MPI_Comm communicator);

    grains::GrainArrays       grains;  // own and ghosts
    grains::GrainLoads        loads;   // on them
    std::vector<std::uint8_t> touched; // the own ones, by contacts in this step

    unsigned int   n_ranks() const { return ranks; }
    std::size_t    n_owned() const { return partition.n_owned; }
    GhostExchange &exchange() { return ghosts; }
    ContactTraffic traffic() const;

    /**
     * Partition @p all grains, which all ranks have, and the @p pairs between them, of @p n_colours colours, so that
     * every rank has about as many of them. Returns the pairs of this rank's grains.
     */
    ContactCandidates divide(const grains::GrainArrays &all,
                             const grains::GrainLoads  &all_loads,
                             const ContactCandidates   &pairs,
                             unsigned int               n_colours);

    /** Whether it was @p all grains that were partitioned, wherever they are now. */
    bool fits(const grains::GrainArrays &all) const { return all.id == all_id; }

    /** Take what @p all grains and loads say of the own ones and the ghosts; nothing has touched them yet. */
    void load(const grains::GrainArrays &all, const grains::GrainLoads &all_loads);

    /** Bring what a step changes of ghosts up to date. Collective. */
    void update_ghosts();

    /** Tell all ranks of the own grains: what a step changes of @p all grains, and whether they were touched.
     * Collective. */
    void collect(grains::GrainArrays &all, std::vector<std::uint8_t> &all_touched);

    /** A row of @p width numbers for each of this rank's grains; those of all grains. Collective. */
    std::vector<double> collect_rows(const std::vector<double> &mine, unsigned int width);

    /** Number of this rank's grain @p k, own or ghost, among all. */
    std::uint32_t number_of(const std::size_t k) const { return partition.grains[k]; }

    /** The impulses of all ranks; those that several know once. Collective. */
    ContactArchive collect(const ContactArchive &mine);

  private:
    GhostExchange                ghosts;
    unsigned int                 ranks = 1, rank = 0;
    ContactPartition             partition;
    std::vector<grains::GrainId> all_id;
    unsigned long long           n_migrated = 0;
  };
} // namespace alluvium::contacts
