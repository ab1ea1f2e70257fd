#include <alluvium/grains/contact_colouring.h>

#include <algorithm>
#include <array>
#include <limits>

namespace alluvium::grains
{
  namespace
  {
    struct Entry
    {
      std::uint64_t hash;
      ContactPair  *pair;
      bool          wall;
    };

    /** Mixes all bits (the finaliser of splitmix64); one to one, so that no two pairs have the same. */
    std::uint64_t hash(const std::uint32_t a, const std::uint32_t b)
    {
      std::uint64_t z = (std::uint64_t(a) << 32) | b;
      z               = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
      z               = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
      return z ^ (z >> 31);
    }

    /** Sort by hash: into buckets by its leading bits, about one entry in each, then each by itself. */
    void sort_by_hash(std::vector<Entry> &entries)
    {
      unsigned int bits = 1;
      while ((std::size_t(1) << bits) < entries.size())
        ++bits;
      const unsigned int         shift = 64 - bits;
      std::vector<std::uint32_t> end((std::size_t(1) << bits) + 1, 0);
      for (const Entry &e : entries)
        ++end[(e.hash >> shift) + 1];
      for (std::size_t k = 1; k < end.size(); ++k)
        end[k] += end[k - 1];
      std::vector<Entry> sorted(entries.size());
      for (const Entry &e : entries)
        sorted[end[e.hash >> shift]++] = e;
      // Buckets are in place: an insertion sort only moves entries within them.
      for (std::size_t k = 1; k < sorted.size(); ++k)
        {
          const Entry e = sorted[k];
          std::size_t m = k;
          for (; m > 0 && sorted[m - 1].hash > e.hash; --m)
            sorted[m] = sorted[m - 1];
          sorted[m] = e;
        }
      entries.swap(sorted);
    }
  } // namespace

  unsigned int colour_contacts(const GrainArrays &grains, ContactCandidates &candidates)
  {
    std::vector<Entry> entries;
    entries.reserve(candidates.discs.size() + candidates.walls.size());
    for (ContactPair &p : candidates.discs)
      {
        const GrainId a = grains.id[p.i], b = grains.id[p.j];
        entries.push_back({hash(std::min(a, b), std::max(a, b)), &p, false});
      }
    for (ContactPair &p : candidates.walls)
      entries.push_back({hash(grains.id[p.i], ~p.j), &p, true});
    sort_by_hash(entries);

    // Bits of the colours in use at every grain; more words only where one grain has very many neighbours.
    for (std::size_t words = 1;; words *= 2)
      {
        std::vector<std::uint64_t> used(words * grains.n(), 0);
        unsigned int               n_colours = 0;
        bool                       enough    = true;
        for (const Entry &e : entries)
          {
            std::uint64_t *const at_i = &used[words * e.pair->i], *const at_j =
                                                                    e.wall ? at_i : &used[words * e.pair->j];
            std::size_t word = 0;
            while (word < words && (at_i[word] | at_j[word]) == std::numeric_limits<std::uint64_t>::max())
              ++word;
            if (word == words)
              {
                enough = false;
                break;
              }
            const std::uint64_t mask = at_i[word] | at_j[word], free = ~mask & (mask + 1);
            unsigned int        colour = 64 * word;
            while (!((free >> (colour % 64)) & 1))
              ++colour;
            at_i[word] |= free;
            at_j[word] |= free;
            e.pair->colour = colour;
            n_colours      = std::max(n_colours, colour + 1);
          }
        if (enough)
          return n_colours;
      }
  }

  void sort_by_colour(std::vector<ContactPair> &pairs, const unsigned int n_colours)
  {
    std::vector<std::size_t> end(n_colours + 1, 0);
    for (const ContactPair &p : pairs)
      ++end[p.colour + 1];
    for (unsigned int c = 0; c < n_colours; ++c)
      end[c + 1] += end[c];
    std::vector<ContactPair> sorted(pairs.size());
    for (const ContactPair &p : pairs)
      sorted[end[p.colour]++] = p;
    pairs.swap(sorted);
  }
} // namespace alluvium::grains
