#include <alluvium/contacts/ranks/contact_partition.h>

#include <algorithm>
#include <limits>
#include <map>

namespace alluvium::contacts
{
  namespace
  {
    using Places = std::vector<double>;
    using Work   = std::vector<std::uint32_t>;

    std::array<double, 2> ends(const Places &x, const std::uint32_t *const begin, const std::uint32_t *const end)
    {
      std::array<double, 2> result = {{x[*begin], x[*begin]}};
      for (const std::uint32_t *k = begin; k != end; ++k)
        result = {{std::min(result[0], x[*k]), std::max(result[1], x[*k])}};
      return result;
    }

    /** Where to cut so that about @p part of the work has smaller coordinates: bins, then bins in one of them. */
    double find_cut(const Places              &x,
                    const Work                &work,
                    const std::uint32_t *const begin,
                    const std::uint32_t *const end,
                    const double               part)
    {
      constexpr int n_bins = 256, n_rounds = 6; // enough also where one grain lies far away from all others
      auto [low, high] = ends(x, begin, end);
      double total     = 0.;
      for (const std::uint32_t *k = begin; k != end; ++k)
        total += work[*k];
      const double target = part * total;
      for (int round = 0; round < n_rounds; ++round)
        {
          std::array<double, n_bins> bins{};
          const double               scale = n_bins / (high - low);
          double                     below = 0.;
          if (!(scale < std::numeric_limits<double>::max()))
            return low;
          for (const std::uint32_t *k = begin; k != end; ++k)
            if (x[*k] < low)
              below += work[*k];
            else if (x[*k] <= high)
              bins[std::min(static_cast<int>((x[*k] - low) * scale), n_bins - 1)] += work[*k];
          int bin = 0;
          while (bin + 1 < n_bins && below + bins[bin] < target)
            below += bins[bin++];
          const double width = (high - low) / n_bins;
          low += bin * width;
          high = low + width;
          if (bins[bin] < 1e-3 * total)
            break;
        }
      return 0.5 * (low + high);
    }

    void bisect(const Places              &x,
                const Places              &y,
                const Work                &work,
                std::uint32_t *const       begin,
                std::uint32_t *const       end,
                const unsigned int         first_rank,
                const unsigned int         n_ranks,
                std::vector<unsigned int> &owner)
    {
      if (n_ranks == 1 || begin == end)
        {
          for (const std::uint32_t *k = begin; k != end; ++k)
            owner[*k] = first_rank;
          return;
        }
      const auto           in_x = ends(x, begin, end), in_y = ends(y, begin, end);
      const Places        &along  = in_x[1] - in_x[0] >= in_y[1] - in_y[0] ? x : y;
      const unsigned int   n_low  = n_ranks / 2;
      const double         cut    = find_cut(along, work, begin, end, static_cast<double>(n_low) / n_ranks);
      std::uint32_t *const middle = std::partition(begin, end, [&](const std::uint32_t k) { return along[k] < cut; });
      bisect(x, y, work, begin, middle, first_rank, n_low, owner);
      bisect(x, y, work, middle, end, first_rank + n_low, n_ranks - n_low, owner);
    }

    void sort_out(std::vector<std::uint32_t> &list)
    {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  } // namespace

  std::vector<unsigned int> bisect(const Places &x, const Places &y, const Work &work, const unsigned int n_ranks)
  {
    std::vector<unsigned int>  owner(x.size(), 0);
    std::vector<std::uint32_t> order(x.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      order[k] = k;
    bisect(x, y, work, order.data(), order.data() + order.size(), 0, n_ranks, owner);
    return owner;
  }

  ContactPartition make_partition(std::vector<unsigned int> owner,
                                  const ContactCandidates  &all,
                                  const unsigned int        n_colours,
                                  const unsigned int        rank)
  {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    ContactPartition        result;
    const std::size_t       n = owner.size();

    // Halos, in indices of all grains first
    std::map<unsigned int, ContactHalo> halos;
    std::vector<std::uint8_t>           in_halo(n, 0);
    for (const ContactPair &p : all.discs)
      if (owner[p.i] != owner[p.j] && (owner[p.i] == rank || owner[p.j] == rank))
        {
          const bool   i_mine = owner[p.i] == rank;
          ContactHalo &halo   = halos[owner[i_mine ? p.j : p.i]];
          halo.send.push_back(i_mine ? p.i : p.j);
          halo.receive.push_back(i_mine ? p.j : p.i);
          in_halo[p.i] = in_halo[p.j] = 1;
        }
    std::vector<const ContactPair *> pairs_there;
    for (const ContactPair &p : all.discs)
      if (in_halo[p.i] || in_halo[p.j])
        pairs_there.push_back(&p);
    std::vector<std::uint8_t> listed(n, 0); // by each halo in turn: 1 to be sent, 2 to be received
    for (auto &[other, halo] : halos)
      {
        halo.rank = other;
        sort_out(halo.send);
        sort_out(halo.receive);
        halo.colour_send.resize(n_colours);
        halo.colour_receive.resize(n_colours);
        for (const std::uint32_t k : halo.send)
          listed[k] = 1;
        for (const std::uint32_t k : halo.receive)
          listed[k] = 2;
        const auto add = [&,
                          other = other](const std::uint32_t k, const unsigned int partner, const unsigned int colour) {
          if (listed[k] == 1 && partner != other)
            halo.colour_send[colour].push_back(k);
          else if (listed[k] == 2 && partner != rank)
            halo.colour_receive[colour].push_back(k);
        };
        for (const ContactPair *const p : pairs_there)
          {
            add(p->i, owner[p->j], p->colour);
            add(p->j, owner[p->i], p->colour);
          }
        for (const ContactPair &p : all.walls)
          add(p.i, none, p.colour);
        for (unsigned int c = 0; c < n_colours; ++c)
          {
            sort_out(halo.colour_send[c]);
            sort_out(halo.colour_receive[c]);
          }
        for (const auto *list : {&halo.send, &halo.receive})
          for (const std::uint32_t k : *list)
            listed[k] = 0;
      }

    // This rank's grains, and the way from all to them
    for (std::size_t k = 0; k < n; ++k)
      if (owner[k] == rank)
        result.grains.push_back(k);
    result.n_owned = result.grains.size();
    for (const auto &[other, halo] : halos)
      result.grains.insert(result.grains.end(), halo.receive.begin(), halo.receive.end());
    std::sort(result.grains.begin() + result.n_owned, result.grains.end());
    std::vector<std::uint32_t> local(n, none);
    for (std::size_t k = 0; k < result.grains.size(); ++k)
      local[result.grains[k]] = k;

    for (const ContactPair &p : all.discs)
      if (owner[p.i] == rank || owner[p.j] == rank)
        {
          result.pairs.discs.push_back(p);
          result.pairs.discs.back().i = local[p.i];
          result.pairs.discs.back().j = local[p.j];
        }
    for (const ContactPair &p : all.walls)
      if (owner[p.i] == rank)
        {
          result.pairs.walls.push_back(p);
          result.pairs.walls.back().i = local[p.i];
        }
    const auto renumber = [&](std::vector<std::uint32_t> &list) {
      for (std::uint32_t &k : list)
        k = local[k];
    };
    for (auto &[other, halo] : halos)
      {
        renumber(halo.send);
        renumber(halo.receive);
        for (unsigned int c = 0; c < n_colours; ++c)
          {
            renumber(halo.colour_send[c]);
            renumber(halo.colour_receive[c]);
          }
        result.halos.push_back(std::move(halo));
      }
    result.owner = std::move(owner);
    return result;
  }
} // namespace alluvium::contacts
