#pragma once

#include <cstdint>
#include <random>

namespace alluvium
{
  /** Random doubles that are the same with every standard library: its engines are fixed by the standard, its
   * distributions not. */
  class RandomNumbers
  {
  public:
    explicit RandomNumbers(const std::uint64_t seed)
      : engine(seed)
    {}

    /** Uniform in [low, high). */
    double uniform(const double low, const double high) { return low + (high - low) * ((engine() >> 11) * 0x1p-53); }

  private:
    std::mt19937_64 engine;
  };
} // namespace alluvium
