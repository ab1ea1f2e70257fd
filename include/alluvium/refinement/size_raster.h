#pragma once

#include <alluvium/mesh/box.h>

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace alluvium::refinement
{
  /**
   * A cell size for every place of a rectangle, held on a raster of buckets: stamped here and there, it grows
   * linearly with the distance from the stamps. Everything costs as much as there are buckets, however many stamps
   * there are; sizes are wanted up to a bucket farther than asked.
   */
  class SizeRaster
  {
  public:
    /**
     * No wish anywhere in @p domain. Buckets have sides of @p spacing [m] or a little less, so that whole ones fill the
     * domain and a mirrored domain has mirrored buckets; or more if they would be over four million. The sizes spread
     * across the boundaries of a @p periodic direction.
     */
    void reinit(const mesh::Box &domain, const std::array<bool, 2> &periodic, const double spacing);

    /** Want at most @p size [m] in @p box; what is outside the domain is left out, or comes in across a periodic
     * boundary. */
    void stamp(const mesh::Box &box, const double size);

    /** Take the smallest wish of all ranks, and let it grow by @p growth per length. Collective. */
    void spread(const MPI_Comm communicator, const double growth);

    /** The smallest size [m] in @p box, or infinity. */
    double smallest_in(const mesh::Box &box) const;

  private:
    struct Range
    {
      std::array<std::size_t, 2> begin, end; // none where they are equal
    };
    Range buckets_in(const mesh::Box &box) const;
    void  stamp_inside(const mesh::Box &box, const double size);

    mesh::Box                  domain;
    std::array<bool, 2>        periodic{};
    std::array<std::size_t, 2> n{};
    std::array<double, 2>      side{{1., 1.}};
    std::vector<double>        size;
  };
} // namespace alluvium::refinement
