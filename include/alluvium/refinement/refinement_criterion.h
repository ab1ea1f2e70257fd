#pragma once

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/grains/bed_faces.h>
#include <alluvium/mesh/box.h>
#include <alluvium/utilities/plugin_interface.h>

#include <array>
#include <limits>

namespace alluvium::refinement
{
  /** The fluid's fields, ghosted, on the mesh as it is before it changes. */
  struct FluidState
  {
    const fluid::FluidSpace<2> &space;
    const fluid::BlockVector   &solution; // velocity [m/s]; reduced pressure [Pa]
    const fluid::Vector        &void_fraction;
  };

  /** What a criterion may know of the present state. The same on all ranks, but for the parts of the fluid's fields. */
  struct RefinementContext
  {
    double                     grain_diameter   = 0.; // mean [m]; 0 without grains
    double                     initial_diameter = 0.; // the same at t = 0 [m]
    grains::BedFaces           bed;
    mesh::Box                  domain;
    std::array<bool, 2>        periodic{};
    double                     time = 0., gravity = 0.; // [s], magnitude [m/s^2]
    const grains::GrainArrays *grains = nullptr;        // replicated
    const FluidState          *fluid  = nullptr;        // none before the first mesh
  };

  /** The context that @p grains make in @p domain; without the fluid. @p grains must outlive it. */
  inline RefinementContext make_refinement_context(const grains::GrainArrays &grains,
                                                   const mesh::Box           &domain,
                                                   const geometry::Upright   &upright = {})
  {
    const unsigned int across = 1 - upright.vertical;

    RefinementContext context;
    context.grain_diameter = context.initial_diameter = mean_diameter(grains);
    context.bed    = find_bed_faces(grains, domain.lower[across], domain.upper[across], upright);
    context.domain = domain;
    context.grains = &grains;
    return context;
  }

  /** What a wanted size is asked for: criteria let go later than they catch, so that the mesh does not flicker. */
  enum class Purpose
  {
    refine,
    coarsen
  };

  /**
   * Interface of the plug-ins that say how fine the fluid's mesh should be. Of several criteria the smallest size wins.
   */
  class RefinementCriterion : public Plugin
  {
  public:
    static constexpr double no_wish = std::numeric_limits<double>::infinity();
    /** What a criterion with a threshold multiplies it by when it is asked for Purpose::coarsen. */
    static constexpr double hysteresis = 0.7;


    /** Look at a new @p context; wanted_size() is asked about it afterwards. Collective. */
    virtual void prepare(const RefinementContext &) {}

    /**
     * The largest cell size [m] that is good enough everywhere in @p box (a larger box never has a larger one), or
     * no_wish.
     */
    virtual double wanted_size(const mesh::Box &box, const RefinementContext &context, const Purpose purpose) const = 0;

    /** The largest size that it ever wants somewhere [m], or no_wish: the unrefined mesh need not be finer. */
    virtual double coarsest_size(const RefinementContext &) const { return no_wish; }

    /** Is coarsest_size() what it wants everywhere and always? */
    virtual bool is_uniform() const { return false; }

    /** Throws UserError if it will want what is no size until @p end_time [s]. */
    virtual void check_until(const double, const RefinementContext &) {}

    /** Does it look at the fluid's fields? */
    virtual bool needs_fluid() const { return false; }
  };
} // namespace alluvium::refinement
