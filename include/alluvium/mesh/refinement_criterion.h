#pragma once

#include <alluvium/mesh/bed_faces.h>

#include <array>
#include <limits>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::mesh
{
  /** What a criterion may know of the present state. The same on all ranks. */
  struct RefinementContext
  {
    double   grain_diameter = 0.; // mean [m]; 0 without grains
    BedFaces bed;
  };

  /** The context that @p grains make in a domain from x = @p left to @p right [m]. */
  inline RefinementContext
  make_refinement_context(const grains::GrainArrays &grains, const double left, const double right)
  {
    return {mean_diameter(grains), find_bed_faces(grains, left, right)};
  }

  /** A rectangle along the axes [m]. */
  struct Box
  {
    std::array<double, 2> lower, upper;
  };

  /**
   * Interface of the plug-ins that say how fine the fluid's mesh should be. Of several criteria the smallest size wins.
   */
  class RefinementCriterion
  {
  public:
    static constexpr double no_wish = std::numeric_limits<double>::infinity();

    virtual ~RefinementCriterion() = default;
    virtual void add_parameters(dealii::ParameterHandler &) {}

    /**
     * The largest cell size [m] that is good enough everywhere in @p box (a larger box never has a larger one), or
     * no_wish.
     */
    virtual double wanted_size(const Box &box, const RefinementContext &context) const = 0;

    /** The largest size that it ever wants somewhere [m], or no_wish: the unrefined mesh need not be finer. */
    virtual double coarsest_size(const RefinementContext &context) const = 0;
  };
} // namespace alluvium::mesh
