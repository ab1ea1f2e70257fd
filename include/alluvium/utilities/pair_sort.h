#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace alluvium
{
  /** Sort @p pairs, which have members i < @p n and j, by (i, j). */
  template <class Pair>
  void sort_pairs(std::vector<Pair> &pairs, const std::size_t n)
  {
    // A counting sort over i, then short runs by j
    std::vector<std::uint32_t> end(n + 1, 0);
    for (const Pair &p : pairs)
      ++end[p.i + 1];
    for (std::size_t k = 0; k < n; ++k)
      end[k + 1] += end[k];
    std::vector<Pair> sorted(pairs.size());
    for (const Pair &p : pairs)
      sorted[end[p.i]++] = p;
    // Runs are in place: an insertion sort only moves pairs within them, and these are few.
    for (std::size_t k = 1; k < sorted.size(); ++k)
      {
        const Pair  p = sorted[k];
        std::size_t m = k;
        for (; m > 0 && sorted[m - 1].i == p.i && sorted[m - 1].j > p.j; --m)
          sorted[m] = sorted[m - 1];
        sorted[m] = p;
      }
    pairs.swap(sorted);
  }
} // namespace alluvium
