#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::coupling
{
  /**
   * The grains, and their images that reach into the domain from beside it: shifted by the length of a periodic box,
   * mirrored at straight sides. What of a grain's disc leaves the domain there comes back in, so that grains which
   * fill the domain evenly fill it evenly up to its sides.
   */
  struct GrainImages
  {
    GrainImages() = default;

    /** Of the grains at (@p grain_x, @p grain_y), whose discs have a radius of at most @p reach; @p mirrors: where the
     * straight sides are, by direction; all [m]. */
    GrainImages(const std::vector<double>                &grain_x,
                const std::vector<double>                &grain_y,
                const double                              reach,
                const fluid::PeriodicBox<2>              &box,
                const std::array<std::vector<double>, 2> &mirrors);

    std::size_t n() const { return x.size(); }

    /** Add an image of image @p k, moved by @p off [m] by a mirror. */
    void add(const std::size_t k, const std::array<double, 2> &off);

    std::vector<double>                x, y;   // [m]
    std::vector<unsigned int>          grain;  // the one it is an image of
    std::vector<std::array<double, 2>> offset; // of a mirror image's centre from the grain's [m]

  private:
    void add(const std::size_t k, const unsigned int d, const double moved, const double off);
  };

  /** [direction]: where those sides of the domain's bounding box are along which its boundary runs from end to end [m].
   * Collective. */
  std::array<std::vector<double>, 2> straight_sides(const fluid::FluidSpace<2> &space);
} // namespace alluvium::coupling
