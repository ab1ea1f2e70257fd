#pragma once

#include <alluvium/coupling/grain_images.h>

namespace alluvium::coupling
{
  /**
   * The sides of the boundary that are not straight_sides() of the bounding box: inclined, curved, of obstacles, both
   * faces of a crack. What of a grain's disc lies behind one, seen from its centre, is mirrored at it, and in corners
   * once more at the next. A disc loses and gains the same area so, and nothing of a grain gets through a wall, however
   * thin.
   */
  class BoundaryMirrors
  {
  public:
    BoundaryMirrors() = default;

    /** Find them, the same on all ranks. Collective. */
    explicit BoundaryMirrors(const fluid::FluidSpace<2> &space);

    bool empty() const { return sides.empty(); }

    /** Add the mirror images of @p images, which have discs of at most @p reach [m]. */
    void add_images(GrainImages &images, const double reach);

    /** Does image @p k of the @p images of the last add_images() see @p point [m]: directly, or in its mirror? */
    bool sees(const GrainImages &images, const std::size_t k, const std::array<double, 2> &point) const;

  private:
    /** From a to b [m], the domain to the left. */
    struct Side
    {
      std::array<double, 2> a, b;
    };

    void join();
    bool is_lit(const std::array<double, 2> &centre, const Side &window, const Side &side, double reach) const;
    bool sees(const GrainImages &, std::size_t k, const std::array<double, 2> &point, double last) const;

    std::vector<Side>         sides;
    std::vector<unsigned int> mirror;      // of each image; largest number: none
    std::vector<unsigned int> parent;      // the image that is seen in the mirror
    std::vector<unsigned int> begin, near; // the sides near each image
  };
} // namespace alluvium::coupling
