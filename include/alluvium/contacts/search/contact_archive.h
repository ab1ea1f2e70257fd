#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <vector>

namespace alluvium::contacts
{
  /** The contact impulses of the last sub-step: what makes the next one start warm, and the bonds of cohesion. Part of
   * a checkpoint. */
  struct ContactArchive
  {
    /** Grain @p a and grain @p b, or wall segment ~b (bits flipped) where `wall`. */
    struct Entry
    {
      grains::GrainId a, b;
      bool            wall, bonded;
      double          rn, rt, rr; // [N s/m]; of SoftSpheres, what they keep there
    };
    double             dt = 0.; // of that sub-step [s]
    std::vector<Entry> entries;

    /** Where walls that move have got to, a.x a.y b.x b.y, the centre, and 1 if they are present, one after the other;
     * empty if none moves. */
    std::vector<double> wall_positions;
  };
} // namespace alluvium::contacts
