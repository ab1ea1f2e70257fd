#include <alluvium/contacts/search/contact_colouring.h>

#include <algorithm>
#include <array>
#include <limits>

namespace alluvium::contacts
{
  namespace
  {
    /** Mixes all bits (the finaliser of splitmix64); one to one, so that no two pairs have the same. */
    std::uint64_t hash(const std::uint32_t a, const std::uint32_t b)
    {
      std::uint64_t z = (std::uint64_t(a) << 32) | b;
      z               = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
      z               = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
      return z ^ (z >> 31);
    }

    /** Numbers of @p n things by hash(number): into buckets by its leading bits, about one in each, then each by
     * itself. */
    template <class Hash>
    std::vector<std::uint32_t> sorted_by_hash(const std::size_t n, const Hash &hash)
    {
      unsigned int bits = 1;
      while ((std::size_t(1) << bits) < n)
        ++bits;
      const unsigned int         shift = 64 - bits;
      std::vector<std::uint32_t> end((std::size_t(1) << bits) + 1, 0), order(n);
      for (std::size_t k = 0; k < n; ++k)
        ++end[(hash(k) >> shift) + 1];
      for (std::size_t k = 1; k < end.size(); ++k)
        end[k] += end[k - 1];
      for (std::size_t k = 0; k < n; ++k)
        order[end[hash(k) >> shift]++] = k;
      // Buckets are in place: an insertion sort only moves numbers within them.
      std::uint64_t before = 0;
      for (std::size_t k = 0; k < n; ++k)
        {
          const std::uint32_t number = order[k];
          const std::uint64_t its    = hash(number);
          std::size_t         m      = k;
          if (its < before)
            for (; m > 0 && hash(order[m - 1]) > its; --m)
              order[m] = order[m - 1];
          else
            before = its;
          order[m] = number;
        }
      return order;
    }
  } // namespace

  unsigned int colour_contacts(const grains::GrainArrays &grains, ContactCandidates &candidates)
  {
    const std::size_t n_discs = candidates.discs.size();
    const auto        order   = sorted_by_hash(n_discs + candidates.walls.size(), [&](const std::size_t k) {
      if (k >= n_discs)
        return hash(grains.id[candidates.walls[k - n_discs].i], ~candidates.walls[k - n_discs].j);
      const grains::GrainId a = grains.id[candidates.discs[k].i], b = grains.id[candidates.discs[k].j];
      return hash(std::min(a, b), std::max(a, b));
    });

    // Bits of the colours in use at every grain; more words only where one grain has very many neighbours.
    for (std::size_t words = 1;; words *= 2)
      {
        std::vector<std::uint64_t> used(words * grains.n(), 0);
        unsigned int               n_colours = 0;
        bool                       enough    = true;
        for (const std::uint32_t k : order)
          {
            const bool           wall = k >= n_discs;
            ContactPair         &pair = wall ? candidates.walls[k - n_discs] : candidates.discs[k];
            std::uint64_t *const at_i = &used[words * pair.i], *const at_j = wall ? at_i : &used[words * pair.j];
            std::size_t word = 0;
            while (word < words && (at_i[word] | at_j[word]) == std::numeric_limits<std::uint64_t>::max())
              ++word;
            if (word == words)
              {
                enough = false;
                break;
              }
            const std::uint64_t mask = at_i[word] | at_j[word], free = ~mask & (mask + 1);
            const unsigned int  colour = 64 * word + __builtin_ctzll(free);
            at_i[word] |= free;
            at_j[word] |= free;
            pair.colour = colour;
            n_colours   = std::max(n_colours, colour + 1);
          }
        if (enough)
          return n_colours;
      }
  }

  std::vector<std::uint32_t> sort_by_colour(std::vector<ContactPair> &pairs, const unsigned int n_colours)
  {
    std::vector<std::uint32_t> end(n_colours + 1, 0), place(pairs.size());
    for (const ContactPair &p : pairs)
      ++end[p.colour + 1];
    for (unsigned int c = 0; c < n_colours; ++c)
      end[c + 1] += end[c];
    std::vector<ContactPair> sorted(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k)
      {
        place[k]         = end[pairs[k].colour]++;
        sorted[place[k]] = pairs[k];
      }
    pairs.swap(sorted);
    return place;
  }
} // namespace alluvium::contacts
