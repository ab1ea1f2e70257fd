#pragma once

#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>

#include <string>
#include <vector>

namespace alluvium::grains
{
  /** Two grains, or a grain and a wall, that are in the same place. */
  struct Overlap
  {
    GrainId     a, b;       // b means nothing if `wall` is not empty
    std::string wall;       // its name
    double      depth = 0.; // [m]
  };

  /** All overlaps deeper than @p tolerance [m], the deepest first. */
  std::vector<Overlap> find_overlaps(const GrainArrays              &grains,
                                     const std::vector<WallSegment> &walls,
                                     double                          tolerance,
                                     const Periodicity              &periodicity = {});

  /** Throw a UserError that names the deepest overlap and counts them if any is deeper than @p tolerance [m]. */
  void check_overlaps(const GrainArrays              &grains,
                      const std::vector<WallSegment> &walls,
                      double                          tolerance,
                      const Periodicity              &periodicity = {});
} // namespace alluvium::grains
