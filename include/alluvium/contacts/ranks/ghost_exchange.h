#pragma once

#include <alluvium/contacts/ranks/contact_partition.h>
#include <alluvium/contacts/solvers/contact_communicator.h>

#include <mpi.h>

#include <vector>

namespace alluvium::contacts
{
  /** What a rank has sent so far, and how long it has been in calls of MPI. */
  struct ContactTraffic
  {
    unsigned long long n_messages   = 0;  // to single ranks
    unsigned long long n_bytes      = 0;  // in them
    unsigned long long n_reductions = 0;  // sums and maxima over all ranks
    double             seconds      = 0.; // of wall time, waiting included
    unsigned long long n_migrated   = 0;  // grains that came to this rank from others
  };

  /** A ContactCommunicator on MPI: messages between ranks that share pairs, and reductions. */
  class GhostExchange : public ContactCommunicator
  {
  public:
    /** On a duplicate of @p communicator. Collective. */
    explicit GhostExchange(MPI_Comm communicator);
    ~GhostExchange() override;
    GhostExchange(const GhostExchange &)            = delete;
    GhostExchange &operator=(const GhostExchange &) = delete;

    void set_halos(std::vector<ContactHalo> new_halos);

    void after_colour(std::vector<Disc> &discs, unsigned int colour) override;
    void update_ghosts(std::vector<Disc> &discs) override;
    void sum(double *values, unsigned int n) override;
    void max(double *values, unsigned int n) override;

    /** Bring the ghosts' entries of some columns, each with one entry for every disc, up to date. */
    void update_ghosts(const std::vector<std::vector<double> *> &columns);

    /** The values of all ranks, one rank's behind the other's; @p counts has how many each brings. */
    std::vector<double> gather(const std::vector<double> &mine, const std::vector<int> &counts);

    MPI_Comm       communicator() const { return comm; }
    ContactTraffic traffic() const { return sent; }

  private:
    MPI_Comm                 comm = MPI_COMM_NULL;
    std::vector<ContactHalo> halos;
    std::vector<double>      out, in;
    std::vector<MPI_Request> requests;
    ContactTraffic           sent;

    template <class Lists, class Put, class Take>
    void exchange(unsigned int width, const Lists &lists, const Put &put, const Take &take);
  };
} // namespace alluvium::contacts
