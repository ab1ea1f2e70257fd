#pragma once

#include <alluvium/coupling/boundary_mirrors.h>
#include <alluvium/coupling/overlap_settings.h>
#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/interphase.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::coupling
{
  /** Where a piece is in its grain, and how far it stretches. */
  struct PieceArm
  {
    std::array<double, 2> arm;     // centroid minus the grain's centre [m]
    std::array<double, 3> moments; // means of (x - centroid)^2, xy, yy over the piece [m^2]
  };

  /**
   * The grains cut by the fluid's cells (paper (9)-(11), figure 1). Every piece knows its grain, its area (rescaled so
   * that a grain's pieces add up to its volume V = pi r_fluid^2, also where the filter's disc leaves the domain) and
   * the means of the shape functions over it. Pieces are sorted by cell, and by grain within a cell.
   */
  class OverlapMap
  {
  public:
    static constexpr int dim = 2;

    explicit OverlapMap(const fluid::FluidSpace<dim> &space);

    /** Prepare the cells' polygons; call after every FluidSpace::reinit(). */
    void reinit();

    /**
     * Cut @p grains: those that moved, in the cells near them; the other pieces are kept. Throws UserError for a grain
     * that touches no cell on any rank. Returns whether anything is other than it was. Collective.
     */
    bool cut(const grains::GrainArrays &grains, const OverlapSettings &settings);

    /** Cut all grains anew next time, for the same bits whether a run was interrupted or not. */
    void forget_positions() { position = {}; }

    /** Where grains were when they were cut last, x and y [m]: the same cut anew gives the same pieces, to the bit. */
    const std::vector<double> &x_of_cut() const { return position.x; }
    const std::vector<double> &y_of_cut() const { return position.y; }

    /** Are the pieces those of @p grains where they are now, to the tolerance of the last cut? */
    bool is_cut_where(const grains::GrainArrays &grains) const;

    /** The pieces; their exchange terms are the time scheme's to fill. */
    fluid::InterphaseTerms<dim>       &terms() { return pieces; }
    const fluid::InterphaseTerms<dim> &terms() const { return pieces; }
    /** Index into the grain arrays, per piece. */
    const std::vector<unsigned int> &grain() const { return grain_of_piece; }
    /** Per piece; empty unless the settings ask for it. */
    const std::vector<PieceArm> &arms() const { return arm_of_piece; }
    bool                         keeps_arms() const { return cut_with.keep_arms; }

    /**
     * Row-sum lumped void fraction (9): 1 - sum over pieces of A phi_i / integral of phi_i. Where that falls below zero
     * (never with the moments rule on parallelograms), it is set to zero and the solid in excess goes to the
     * neighbouring nodes. Returns the volume moved so [m^2]. Collective.
     */
    double void_fraction(fluid::Vector &eps) const;

    /** Does some rank cut rectangles cell by cell, since their sides lie on too many lines for their number? */
    bool is_too_uneven() const { return too_uneven; }

    /** Sum a per-grain array over all ranks, with the same bits on all of them. */
    void sum_over_ranks(std::vector<double> &per_grain) const;

  private:
    /** Pieces that were, by cell. */
    struct PieceStore;

    /** Replace the pieces by those of @p now: in all cells, or in those that grains near them have moved. */
    void cut_on_grid(const GrainImages               &now,
                     const GrainImages               &before,
                     const std::vector<std::uint8_t> &moved,
                     const OverlapSettings           &settings);
    /** The same, cell by cell and for cells of any shape. */
    void cut_cells(const GrainImages               &now,
                   const GrainImages               &before,
                   const std::vector<std::uint8_t> &moved,
                   const OverlapSettings           &settings);
    /** The pieces, of which none are left here. */
    PieceStore take_pieces();
    void       resize_pieces(const std::size_t n);
    /** Copy a cell's pieces to index @p at and after. */
    void put_back(const PieceStore &old, const unsigned int cell, const std::size_t at);
    /** Bring @p position up to date; which grains moved. */
    std::vector<std::uint8_t> find_moved(const grains::GrainArrays &grains, const OverlapSettings &settings);
    void                      add_piece(const unsigned int       cell,
                                        const unsigned int       grain,
                                        const geometry::Overlap &overlap,
                                        const OverlapSettings   &settings);

    const fluid::FluidSpace<dim>          *space;
    std::vector<geometry::PreparedPolygon> polygons;
    geometry::RectangleGrid                grid; // of the same; empty where they are no rectangles
    bool                                   too_uneven = false;
    std::array<std::vector<double>, dim>   mirrors;       // straight_sides() of the domain
    BoundaryMirrors                        other_mirrors; // its other sides
    fluid::InterphaseTerms<dim>            pieces;
    std::vector<unsigned int>              grain_of_piece;
    std::vector<PieceArm>                  arm_of_piece;
    std::vector<double>                    raw_area; // of each piece, before weights [m^2]

    /** The discs as they were cut; empty: nothing is. */
    struct Positions
    {
      std::vector<double> x, y, radius, fluid_radius;
    };
    Positions       position;
    OverlapSettings cut_with;
  };
} // namespace alluvium::coupling
