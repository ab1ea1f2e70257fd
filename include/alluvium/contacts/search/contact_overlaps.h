#pragma once

#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>

#include <string>
#include <vector>

namespace alluvium::contacts
{
  /** Two grains, or a grain and a wall, that are in the same place. */
  struct Overlap
  {
    grains::GrainId a, b;       // b means nothing if `wall` is not empty
    std::string     wall;       // its name
    double          depth = 0.; // [m]
  };

  /** All overlaps deeper than @p tolerance [m], the deepest first. */
  std::vector<Overlap> find_overlaps(const grains::GrainArrays              &grains,
                                     const std::vector<grains::WallSegment> &walls,
                                     double                                  tolerance,
                                     const grains::Periodicity              &periodicity = {});

  /** Throw a UserError that names the deepest overlap and counts them if any is deeper than @p tolerance [m]. */
  void check_overlaps(const grains::GrainArrays              &grains,
                      const std::vector<grains::WallSegment> &walls,
                      double                                  tolerance,
                      const grains::Periodicity              &periodicity = {});
} // namespace alluvium::contacts
