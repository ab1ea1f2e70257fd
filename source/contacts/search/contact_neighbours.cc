#include <alluvium/contacts/search/contact_colouring.h>
#include <alluvium/contacts/search/contact_neighbours.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    /** Whether there is anything to remember. */
    bool is_known(const ContactPair &p)
    {
      return p.rn != 0. || p.rt != 0. || p.rr != 0. || p.bonded;
    }

    std::size_t n_known(const std::vector<ContactPair> &pairs)
    {
      return std::count_if(pairs.begin(), pairs.end(), is_known);
    }

    std::uint64_t key(const std::uint32_t a, const std::uint32_t b)
    {
      return (std::uint64_t(a) << 32) | b;
    }

    std::uint64_t key(const ContactArchive::Entry &e)
    {
      return key(e.a, e.wall ? ~e.b : e.b);
    }

    /** Grains' entries before walls', each by its key. */
    bool comes_before(const ContactArchive::Entry &p, const ContactArchive::Entry &q)
    {
      return p.wall != q.wall ? q.wall : key(p) < key(q);
    }
  } // namespace

  void ContactNeighbours::search(const grains::GrainArrays &grains, const ContactGeometry &geometry, const double skin)
  {
    forget();
    pairs       = find_candidates(grains, geometry, skin);
    n_colours   = colour_contacts(grains, pairs);
    searched_id = grains.id;
    searched_x  = grains.position[0];
    searched_y  = grains.position[1];
    n_owned     = grains.n();
    this->skin  = skin;
    searched    = true;
    record      = {true, grains.position[0], grains.position[1], geometry.walls.positions(), skin, skin};
    carry(grains, pairs.discs, false);
    carry(grains, pairs.walls, true);
    pending    = {};
    disc_order = sort_by_colour(pairs.discs, n_colours);
    wall_order = sort_by_colour(pairs.walls, n_colours);
  }

  void ContactNeighbours::keep(ContactCandidates share, const grains::GrainArrays &grains, const std::size_t n_owned)
  {
    pairs = std::move(share);
    disc_order.clear();
    wall_order.clear();
    searched_id   = grains.id;
    searched_x    = grains.position[0];
    searched_y    = grains.position[1];
    this->n_owned = n_owned;
  }

  ContactSearchRecord ContactNeighbours::last_search() const
  {
    if (!searched)
      return {};
    ContactSearchRecord result = record;
    result.left                = skin;
    return result;
  }

  void ContactNeighbours::repeat(const ContactSearchRecord &last,
                                 const grains::GrainArrays &grains,
                                 const ContactGeometry     &geometry)
  {
    search(grains, geometry, last.skin);
    skin = last.left;
  }

  void
  ContactNeighbours::carry(const grains::GrainArrays &grains, std::vector<ContactPair> &found, const bool wall) const
  {
    const auto first_wall = std::partition_point(
      pending.entries.begin(), pending.entries.end(), [](const ContactArchive::Entry &e) { return !e.wall; });
    const auto begin = wall ? first_wall : pending.entries.begin(), end = wall ? pending.entries.end() : first_wall;
    // Where the pairs come sorted by ids, this is one pass through both lists.
    auto it = begin;
    for (ContactPair &p : found)
      {
        const std::uint64_t k = key(grains.id[p.i], wall ? p.j : grains.id[p.j]);
        if (it != begin && key(*std::prev(it)) >= k)
          it = std::lower_bound(begin, it, k, [](const auto &e, const std::uint64_t v) { return key(e) < v; });
        while (it != end && key(*it) < k)
          ++it;
        if (it != end && key(*it) == k)
          {
            p.bonded = it->bonded;
            p.rn     = it->rn;
            p.rt     = it->rt;
            p.rr     = it->rr;
          }
      }
  }

  void ContactNeighbours::set_pending(ContactArchive archive)
  {
    pending = std::move(archive);
    if (!std::is_sorted(pending.entries.begin(), pending.entries.end(), comes_before))
      std::sort(pending.entries.begin(), pending.entries.end(), comes_before);
  }

  void ContactNeighbours::forget()
  {
    set_pending(archive());
    searched = false;
    pairs    = {};
  }

  double ContactNeighbours::slack(const grains::GrainArrays &grains,
                                  const grains::Periodicity &periodicity,
                                  ContactCommunicator       *communicator) const
  {
    double first = 0., second = 0.;
    for (std::size_t k = 0; k < n_owned; ++k)
      {
        double dx = grains.position[0][k] - searched_x[k], dy = grains.position[1][k] - searched_y[k];
        periodicity.shorten(dx, dy);
        const double d = dx * dx + dy * dy;
        if (d > first)
          {
            second = first;
            first  = d;
          }
        else if (d > second)
          second = d;
      }
    const auto [farthest, next] = largest_over_ranks(communicator, {{first, second}});
    return skin - (std::sqrt(farthest) + std::sqrt(next));
  }

  void ContactNeighbours::rescale(const double h)
  {
    if (warm_dt > 0. && warm_dt != h)
      {
        const double scale = h / warm_dt;
        for (auto *list : {&pairs.discs, &pairs.walls})
          for (ContactPair &p : *list)
            {
              p.rn *= scale;
              p.rt *= scale;
              p.rr *= scale;
            }
        for (auto &e : pending.entries)
          {
            e.rn *= scale;
            e.rt *= scale;
            e.rr *= scale;
          }
      }
    warm_dt = h;
  }

  ContactArchive ContactNeighbours::archive() const
  {
    if (!searched)
      {
        ContactArchive result = pending;
        result.dt             = warm_dt;
        return result;
      }
    ContactArchive result;
    result.dt = warm_dt;
    result.entries.reserve(n_known(pairs.discs) + n_known(pairs.walls));
    add_to(result, false);
    add_to(result, true);
    return result;
  }

  void ContactNeighbours::add_to(ContactArchive &archive, const bool wall) const
  {
    const std::vector<ContactPair>   &list  = wall ? pairs.walls : pairs.discs;
    const std::vector<std::uint32_t> &order = wall ? wall_order : disc_order;
    for (std::size_t k = 0; k < list.size(); ++k)
      if (const ContactPair &p = list[order.empty() ? k : order[k]]; p.i < n_owned && is_known(p))
        {
          ContactArchive::Entry &e = archive.entries.emplace_back();
          e.a                      = searched_id[p.i];
          e.b                      = wall ? ~p.j : searched_id[p.j];
          e.wall                   = wall;
          e.bonded                 = p.bonded;
          e.rn                     = p.rn;
          e.rt                     = p.rt;
          e.rr                     = p.rr;
        }
  }

  void ContactNeighbours::set_archive(ContactArchive archive)
  {
    pairs = {};
    set_pending(std::move(archive));
    warm_dt  = pending.dt;
    searched = false;
  }
} // namespace alluvium::contacts
