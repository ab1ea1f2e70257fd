#include <alluvium/contacts/ranks/contact_subdomain.h>
#include <alluvium/grains/grain_columns.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace alluvium::contacts
{
  namespace
  {
    using When = grains::GrainColumn::When;

    /** Take of @p all grains' columns that are @p when the rows of @p numbers. */
    void take_rows(const grains::GrainArrays        &all,
                   const std::vector<std::uint32_t> &numbers,
                   const When                        when,
                   grains::GrainArrays              &some)
    {
      const auto from = columns_of(all, when);
      const auto to   = columns_of(some, when);
      for (std::size_t c = 0; c < from.size(); ++c)
        for (std::size_t k = 0; k < numbers.size(); ++k)
          (*to[c])[k] = (*from[c])[numbers[k]];
    }

    constexpr unsigned int n_wire = 7; // numbers of an archive's entry on the wire
  }                                    // namespace

  ContactSubdomain::ContactSubdomain(const MPI_Comm communicator)
    : ghosts(communicator)
  {
    int value;
    MPI_Comm_size(communicator, &value);
    ranks = value;
    MPI_Comm_rank(communicator, &value);
    rank = value;
  }

  ContactCandidates ContactSubdomain::divide(const grains::GrainArrays &all,
                                             const grains::GrainLoads  &all_loads,
                                             const ContactCandidates   &pairs,
                                             const unsigned int         n_colours)
  {
    std::vector<std::uint32_t> work(all.n(), 1);
    for (const ContactPair &p : pairs.discs)
      {
        ++work[p.i];
        ++work[p.j];
      }
    const std::vector<unsigned int> was_owner = std::move(partition.owner);
    partition = make_partition(bisect(all.position[0], all.position[1], work, ranks), pairs, n_colours, rank);
    if (fits(all))
      for (std::size_t k = 0; k < was_owner.size(); ++k)
        n_migrated += partition.owner[k] == rank && was_owner[k] != rank;
    ghosts.set_halos(std::move(partition.halos));
    all_id              = all.id;
    const std::size_t n = partition.grains.size();
    grains.resize(n);
    for (std::size_t k = 0; k < n; ++k)
      grains.id[k] = all.id[partition.grains[k]];
    take_rows(all, partition.grains, When::constant, grains);
    load(all, all_loads);
    return std::move(partition.pairs);
  }

  ContactTraffic ContactSubdomain::traffic() const
  {
    ContactTraffic result = ghosts.traffic();
    result.n_migrated     = n_migrated;
    return result;
  }

  void ContactSubdomain::load(const grains::GrainArrays &all, const grains::GrainLoads &all_loads)
  {
    const std::size_t n = grains.n();
    take_rows(all, partition.grains, When::changing, grains);
    loads.reset(n);
    for (std::size_t k = 0; k < n; ++k)
      {
        for (unsigned int d = 0; d < 2; ++d)
          loads.force[d][k] = all_loads.force[d][partition.grains[k]];
        loads.drag[k] = all_loads.drag[partition.grains[k]];
      }
    for (auto v : {&grains::GrainLoads::added_mass, &grains::GrainLoads::torque, &grains::GrainLoads::spin_drag})
      if (!(all_loads.*v).empty())
        {
          (loads.*v).resize(n);
          for (std::size_t k = 0; k < n; ++k)
            (loads.*v)[k] = (all_loads.*v)[partition.grains[k]];
        }
    touched.assign(n, 0);
  }

  void ContactSubdomain::update_ghosts()
  {
    // what a sub-step looks at in the other grain of a pair
    ghosts.update_ghosts(
      {&grains.position[0], &grains.position[1], &grains.velocity[0], &grains.velocity[1], &grains.omega});
  }

  std::vector<double> ContactSubdomain::collect_rows(const std::vector<double> &mine, const unsigned int width)
  {
    std::vector<int> counts(ranks, 0);
    for (const unsigned int r : partition.owner)
      counts[r] += width;
    const std::vector<double> got = ghosts.gather(mine, counts);
    // A rank's rows come in the order of its grains among all.
    std::vector<const double *> next(ranks, got.data());
    for (unsigned int r = 1; r < ranks; ++r)
      next[r] = next[r - 1] + counts[r - 1];
    std::vector<double> result(width * partition.owner.size());
    double             *to = result.data();
    for (const unsigned int r : partition.owner)
      {
        to = std::copy(next[r], next[r] + width, to);
        next[r] += width;
      }
    return result;
  }

  void ContactSubdomain::collect(grains::GrainArrays &all, std::vector<std::uint8_t> &all_touched)
  {
    const auto          mine = columns_of(grains, When::changing), everyones = columns_of(all, When::changing);
    const unsigned int  width = mine.size() + 1;
    std::vector<double> rows;
    rows.reserve(width * n_owned());
    for (std::size_t k = 0; k < n_owned(); ++k)
      {
        for (const auto *column : mine)
          rows.push_back((*column)[k]);
        rows.push_back(touched[k]);
      }
    rows = collect_rows(rows, width);
    for (std::size_t k = 0; k < all.n(); ++k)
      {
        const double *const row = &rows[width * k];
        for (unsigned int c = 0; c < everyones.size(); ++c)
          (*everyones[c])[k] = row[c];
        all_touched[k] = row[everyones.size()] != 0.;
      }
  }

  ContactArchive ContactSubdomain::collect(const ContactArchive &mine)
  {
    std::vector<double> rows;
    rows.reserve(n_wire * mine.entries.size());
    for (const auto &e : mine.entries)
      for (const double value : {double(e.a), double(e.b), double(e.wall), double(e.bonded), e.rn, e.rt, e.rr})
        rows.push_back(value);
    int              count = rows.size();
    std::vector<int> counts(ranks);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, ghosts.communicator());
    rows = ghosts.gather(rows, counts);

    ContactArchive result;
    result.dt             = mine.dt;
    result.wall_positions = mine.wall_positions;
    result.entries.reserve(rows.size() / n_wire);
    for (std::size_t k = 0; k < rows.size(); k += n_wire)
      result.entries.push_back({static_cast<grains::GrainId>(rows[k]),
                                static_cast<grains::GrainId>(rows[k + 1]),
                                rows[k + 2] != 0.,
                                rows[k + 3] != 0.,
                                rows[k + 4],
                                rows[k + 5],
                                rows[k + 6]});
    // In the order in which one rank has them
    const auto key = [](const ContactArchive::Entry &e) { return std::make_tuple(e.wall, e.a, e.wall ? ~e.b : e.b); };
    std::sort(
      result.entries.begin(), result.entries.end(), [&](const auto &p, const auto &q) { return key(p) < key(q); });
    result.entries.erase(std::unique(result.entries.begin(),
                                     result.entries.end(),
                                     [&](const auto &p, const auto &q) { return key(p) == key(q); }),
                         result.entries.end());
    return result;
  }
} // namespace alluvium::contacts
