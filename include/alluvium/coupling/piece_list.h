#pragma once

#include <alluvium/fluid/interphase.h>

#include <array>
#include <vector>

namespace alluvium::coupling
{
  /** Where a piece, the intersection of a grain and a cell, is in its grain, and how far it stretches. */
  struct PieceArm
  {
    std::array<double, 2> arm;     // centroid minus the grain's centre [m]
    std::array<double, 3> moments; // means of (x - centroid)^2, xy, yy over the piece [m^2]
  };

  /** The pieces that cells cut from discs: sorted by cell, and by grain within a cell. */
  struct PieceList
  {
    fluid::InterphaseTerms<2> terms;    // begin of each cell, shape, exchange
    std::vector<unsigned int> grain;    // index into the grain arrays
    std::vector<double>       raw_area; // before weights [m^2]
    std::vector<PieceArm>     arm;      // empty unless they are kept
    bool                      keeps_arms = false;

    std::size_t  n() const { return grain.size(); }
    unsigned int n(const unsigned int cell) const { return terms.begin[cell + 1] - terms.begin[cell]; }

    /** The pieces, of which none are left here; the exchange terms stay. */
    PieceList take();
    void      reserve(const std::size_t n);
    void      resize(const std::size_t n);
    /** Copy the pieces of @p cell of @p old to index @p at and after. */
    void copy(const PieceList &old, const unsigned int cell, const std::size_t at);
  };
} // namespace alluvium::coupling
