#include <alluvium/contacts/ranks/ghost_exchange.h>
#include <alluvium/contacts/solvers/contact_problem.h>

#include <utility>

namespace alluvium::contacts
{
  namespace
  {
    /** Adds the wall time of its life to a sum. */
    class Stopwatch
    {
    public:
      explicit Stopwatch(double &seconds)
        : seconds(seconds)
        , start(MPI_Wtime())
      {}
      ~Stopwatch() { seconds += MPI_Wtime() - start; }

    private:
      double      &seconds;
      const double start;
    };

    void put_velocity(const Disc &disc, double *const to)
    {
      to[0] = disc.x;
      to[1] = disc.y;
      to[2] = disc.s;
    }

    void take_velocity(Disc &disc, const double *const from)
    {
      disc.x = from[0];
      disc.y = from[1];
      disc.s = from[2];
    }
  } // namespace

  GhostExchange::GhostExchange(const MPI_Comm communicator)
  {
    MPI_Comm_dup(communicator, &comm);
  }

  GhostExchange::~GhostExchange()
  {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (!is_over)
      MPI_Comm_free(&comm);
  }

  void GhostExchange::set_halos(std::vector<ContactHalo> new_halos)
  {
    halos = std::move(new_halos);
  }

  /** Exchange @p width numbers of each disc in @p lists(halo), a pair of lists to send and to receive. */
  template <class Lists, class Put, class Take>
  void GhostExchange::exchange(const unsigned int width, const Lists &lists, const Put &put, const Take &take)
  {
    std::size_t n_out = 0, n_in = 0;
    for (const ContactHalo &b : halos)
      {
        n_out += lists(b).first.size();
        n_in += lists(b).second.size();
      }
    if (n_out + n_in == 0)
      return;
    out.resize(std::max(out.size(), width * n_out));
    in.resize(std::max(in.size(), width * n_in));
    requests.clear();
    {
      const Stopwatch stopwatch(sent.seconds);
      double         *to = in.data();
      for (const ContactHalo &b : halos)
        if (const std::size_t n = width * lists(b).second.size(); n > 0)
          {
            requests.emplace_back();
            MPI_Irecv(to, n, MPI_DOUBLE, b.rank, 0, comm, &requests.back());
            to += n;
          }
    }
    double *from = out.data();
    for (const ContactHalo &b : halos)
      {
        double *const begin = from;
        for (const std::uint32_t k : lists(b).first)
          {
            put(k, from);
            from += width;
          }
        if (from == begin)
          continue;
        const Stopwatch stopwatch(sent.seconds);
        requests.emplace_back();
        MPI_Isend(begin, from - begin, MPI_DOUBLE, b.rank, 0, comm, &requests.back());
        ++sent.n_messages;
        sent.n_bytes += sizeof(double) * (from - begin);
      }
    {
      const Stopwatch stopwatch(sent.seconds);
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    }
    const double *got = in.data();
    for (const ContactHalo &b : halos)
      for (const std::uint32_t k : lists(b).second)
        {
          take(k, got);
          got += width;
        }
  }

  void GhostExchange::after_colour(std::vector<Disc> &discs, const unsigned int colour)
  {
    exchange(
      3,
      [&](const ContactHalo &b) {
        return std::pair<const std::vector<std::uint32_t> &, const std::vector<std::uint32_t> &>(
          b.colour_send[colour], b.colour_receive[colour]);
      },
      [&](const std::uint32_t k, double *const to) { put_velocity(discs[k], to); },
      [&](const std::uint32_t k, const double *const from) { take_velocity(discs[k], from); });
  }

  void GhostExchange::update_ghosts(std::vector<Disc> &discs)
  {
    exchange(
      3,
      [](const ContactHalo &b) {
        return std::pair<const std::vector<std::uint32_t> &, const std::vector<std::uint32_t> &>(b.send, b.receive);
      },
      [&](const std::uint32_t k, double *const to) { put_velocity(discs[k], to); },
      [&](const std::uint32_t k, const double *const from) { take_velocity(discs[k], from); });
  }

  void GhostExchange::update_ghosts(const std::vector<std::vector<double> *> &columns)
  {
    exchange(
      columns.size(),
      [](const ContactHalo &b) {
        return std::pair<const std::vector<std::uint32_t> &, const std::vector<std::uint32_t> &>(b.send, b.receive);
      },
      [&](const std::uint32_t k, double *const to) {
        for (std::size_t c = 0; c < columns.size(); ++c)
          to[c] = (*columns[c])[k];
      },
      [&](const std::uint32_t k, const double *const from) {
        for (std::size_t c = 0; c < columns.size(); ++c)
          (*columns[c])[k] = from[c];
      });
  }

  void GhostExchange::sum(double *const values, const unsigned int n)
  {
    const Stopwatch stopwatch(sent.seconds);
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, comm);
    ++sent.n_reductions;
  }

  void GhostExchange::max(double *const values, const unsigned int n)
  {
    const Stopwatch stopwatch(sent.seconds);
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_MAX, comm);
    ++sent.n_reductions;
  }

  std::vector<double> GhostExchange::gather(const std::vector<double> &mine, const std::vector<int> &counts)
  {
    std::vector<int> offsets(counts.size() + 1, 0);
    for (std::size_t k = 0; k < counts.size(); ++k)
      offsets[k + 1] = offsets[k] + counts[k];
    std::vector<double> all(offsets.back());
    const Stopwatch     stopwatch(sent.seconds);
    MPI_Allgatherv(mine.data(), mine.size(), MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, comm);
    return all;
  }
} // namespace alluvium::contacts
