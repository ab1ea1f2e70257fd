#pragma once

#include <alluvium/coupling/boundary_mirrors.h>
#include <alluvium/coupling/overlap_settings.h>
#include <alluvium/coupling/piece_list.h>
#include <alluvium/fluid/fluid_space.h>

#include <cstdint>

namespace alluvium::coupling
{
  /** The discs that are cut, one per grain; all [m]. */
  struct Discs
  {
    std::array<std::vector<double>, 2> position;
    std::vector<double>                radius;

    std::size_t n() const { return radius.size(); }
    double      largest_radius() const;
  };


  /** Cuts discs, and their images in walls and periodic boxes, with the cells of a mesh. */
  class DiscCutter
  {
  public:
    static constexpr int dim = 2;

    explicit DiscCutter(const fluid::FluidSpace<dim> &space)
      : space(&space)
    {}

    /** Prepare the cells' polygons; after every FluidSpace::reinit(). Collective. */
    void reinit();

    std::size_t n_cells() const { return polygons.size(); }

    /**
     * Replace @p pieces by those of @p now: in all cells if nothing is known of @p before (no discs), else in those
     * that discs which @p moved are near, or were.
     */
    void cut(const Discs                     &now,
             const Discs                     &before,
             const std::vector<std::uint8_t> &moved,
             const OverlapSettings           &settings,
             PieceList                       &pieces);

    /** Does some rank cut rectangles cell by cell, since their sides lie on too many lines for their number? */
    bool is_non_tensor() const { return non_tensor; }

  private:
    /** Along the lines of a mesh of rectangles. */
    void cut_on_grid(const Discs                     &discs,
                     const GrainImages               &now,
                     const GrainImages               &before,
                     const std::vector<std::uint8_t> &moved,
                     const OverlapSettings           &settings,
                     PieceList                       &pieces) const;
    /** The same, cell by cell and for cells of any shape. */
    void cut_cells(const Discs                     &discs,
                   const GrainImages               &now,
                   const GrainImages               &before,
                   const std::vector<std::uint8_t> &moved,
                   const OverlapSettings           &settings,
                   PieceList                       &pieces) const;
    void add_piece(const unsigned int       cell,
                   const unsigned int       grain,
                   const geometry::Overlap &overlap,
                   const OverlapSettings   &settings,
                   PieceList               &pieces) const;

    const fluid::FluidSpace<dim>          *space;
    std::vector<geometry::PreparedPolygon> polygons;
    geometry::RectangleGrid                grid; // of the same; empty where they are no rectangles
    bool                                   non_tensor = false;
    std::array<std::vector<double>, dim>   mirrors;       // straight_sides() of the domain
    BoundaryMirrors                        other_mirrors; // its other sides
  };
} // namespace alluvium::coupling
