#pragma once

#include <cstdint>
#include <vector>

namespace alluvium::grains
{
  /**
   * Colours contacts such that those of one colour share no disc: the sweeps then run without waiting for each other.
   */
  class ContactColouring
  {
  public:
    static constexpr unsigned int n_colours = 64;

    void reset(const std::size_t n_discs) { used.assign(n_discs, 0); }

    /** The first colour free at disc @p i, taken from now on. */
    unsigned int add(const std::uint32_t i)
    {
      const unsigned int colour = first_free(used[i]);
      used[i] |= std::uint64_t(1) << colour;
      return colour;
    }

    /** The first colour free at both discs. */
    unsigned int add(const std::uint32_t i, const std::uint32_t j)
    {
      const unsigned int colour = first_free(used[i] | used[j]);
      used[i] |= std::uint64_t(1) << colour;
      used[j] |= std::uint64_t(1) << colour;
      return colour;
    }

  private:
    std::vector<std::uint64_t> used;

    static unsigned int first_free(const std::uint64_t mask)
    {
      unsigned int colour = 0;
      while (colour + 1 < n_colours && ((mask >> colour) & 1))
        ++colour;
      return colour;
    }
  };
} // namespace alluvium::grains
