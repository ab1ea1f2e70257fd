#include <alluvium/grains/contact_colouring.h>
#include <alluvium/grains/contact_neighbours.h>
#include <alluvium/grains/contact_pair_sort.h>
#include <alluvium/grains/contact_reductions.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  namespace
  {
    std::uint64_t key(const std::uint32_t a, const std::uint32_t b)
    {
      return (std::uint64_t(a) << 32) | b;
    }
  } // namespace

  void ContactNeighbours::search(const GrainArrays &grains, const ContactGeometry &geometry, const double skin)
  {
    forget();
    pairs       = find_candidates(grains, geometry, skin);
    n_colours   = colour_contacts(grains, pairs);
    searched_id = grains.id;
    searched_x  = grains.x;
    searched_y  = grains.y;
    n_owned     = grains.n();
    this->skin  = skin;
    searched    = true;
    carry(grains, pairs.discs, false);
    carry(grains, pairs.walls, true);
    pending = {};
    sort_by_colour(pairs.discs, n_colours);
    sort_by_colour(pairs.walls, n_colours);
  }

  void ContactNeighbours::keep(ContactCandidates share, const GrainArrays &grains, const std::size_t n_owned)
  {
    pairs         = std::move(share);
    searched_id   = grains.id;
    searched_x    = grains.x;
    searched_y    = grains.y;
    this->n_owned = n_owned;
  }

  void ContactNeighbours::carry(const GrainArrays &grains, std::vector<ContactPair> &found, const bool wall) const
  {
    std::vector<std::pair<std::uint64_t, const ContactArchive::Entry *>> list;
    for (const auto &e : pending.entries)
      if (e.wall == wall)
        list.emplace_back(key(e.a, wall ? ~e.b : e.b), &e);
    const auto lower = [](const auto &p, const auto &q) { return p.first < q.first; };
    if (!std::is_sorted(list.begin(), list.end(), lower))
      std::sort(list.begin(), list.end(), lower);

    // Where the pairs come sorted by ids, this is one pass through both lists.
    auto it = list.begin();
    for (ContactPair &p : found)
      {
        const std::uint64_t k = key(grains.id[p.i], wall ? p.j : grains.id[p.j]);
        if (it != list.begin() && std::prev(it)->first >= k)
          it = std::lower_bound(list.begin(), it, k, [](const auto &e, const std::uint64_t v) { return e.first < v; });
        while (it != list.end() && it->first < k)
          ++it;
        if (it != list.end() && it->first == k)
          {
            p.bonded = it->second->bonded;
            p.rn     = it->second->rn;
            p.rt     = it->second->rt;
            p.rr     = it->second->rr;
          }
      }
  }

  void ContactNeighbours::forget()
  {
    pending  = archive();
    searched = false;
    pairs    = {};
  }

  double ContactNeighbours::slack(const GrainArrays   &grains,
                                  const Periodicity   &periodicity,
                                  ContactCommunicator *communicator) const
  {
    double first = 0., second = 0.;
    for (std::size_t k = 0; k < n_owned; ++k)
      {
        double dx = grains.x[k] - searched_x[k], dy = grains.y[k] - searched_y[k];
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
    struct Place
    {
      std::uint32_t i, j, pair;
    };
    std::vector<Place> places;
    for (const bool wall : {false, true})
      {
        const std::vector<ContactPair> &list = wall ? pairs.walls : pairs.discs;
        const auto        known = [&](const ContactPair &p) { return p.i < n_owned && (p.rn != 0. || p.bonded); };
        const std::size_t n     = std::count_if(list.begin(), list.end(), known);
        places.clear();
        places.reserve(n);
        for (std::uint32_t k = 0; k < list.size(); ++k)
          if (known(list[k]))
            places.push_back({list[k].i, list[k].j, k});
        sort_pairs(places, n_owned);
        result.entries.reserve(result.entries.size() + n);
        for (const Place &place : places)
          {
            const ContactPair &p = list[place.pair];
            result.entries.push_back(
              {searched_id[p.i], wall ? ~p.j : searched_id[p.j], wall, p.bonded, p.rn, p.rt, p.rr});
          }
      }
    return result;
  }

  void ContactNeighbours::set_archive(ContactArchive archive)
  {
    pairs    = {};
    pending  = std::move(archive);
    warm_dt  = pending.dt;
    searched = false;
  }
} // namespace alluvium::grains
