#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace alluvium::coupling
{
  /** Discs sorted into square bins, so that a cell finds the discs near it. */
  class GrainBins
  {
  public:
    /** Bins of side @p width [m], or wider if they were many more than discs, for discs, at least one, at (@p x, @p y)
     * [m]. */
    GrainBins(const std::vector<double> &x, const std::vector<double> &y, double width);

    /** All discs whose centres may lie in the box, in rising order. */
    void
    find(const std::array<double, 2> &low, const std::array<double, 2> &high, std::vector<unsigned int> &found) const;

    /** Note that something changed at (x, y). */
    void mark(double x, double y);

    /** Did anything change in the box? */
    bool is_marked(const std::array<double, 2> &low, const std::array<double, 2> &high) const;

  private:
    int index(double x, unsigned int direction) const;

    double                    width;
    std::array<double, 2>     lower;
    std::array<int, 2>        n;
    std::vector<unsigned int> begin, member;
    std::vector<std::uint8_t> marked;
  };
} // namespace alluvium::coupling
