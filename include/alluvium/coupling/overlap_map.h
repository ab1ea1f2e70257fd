#pragma once

#include <alluvium/coupling/disc_cutter.h>
#include <alluvium/grains/grain_arrays.h>

namespace alluvium::coupling
{
  /**
   * The grains cut by the fluid's cells (paper (9)-(11), figure 1). A piece is the intersection of a grain, or of its
   * filter's disc, and a cell. It knows its grain, its area (rescaled so that a grain's pieces add up to its volume V =
   * pi r_fluid^2, also where the filter's disc leaves the domain) and the means of the shape functions over it. Pieces
   * are sorted by cell, and by grain within a cell.
   */
  class OverlapMap
  {
  public:
    static constexpr int dim = 2;

    explicit OverlapMap(const fluid::FluidSpace<dim> &space);

    /** After every FluidSpace::reinit(). Collective. */
    void reinit();

    /**
     * Cut @p grains: those that moved, in the cells near them; the other pieces are kept. Throws UserError for a grain
     * that touches no cell on any rank. Returns whether anything is other than it was. Collective.
     */
    bool cut(const grains::GrainArrays &grains, const OverlapSettings &settings);

    /** Cut all grains anew next time, for the same bits whether a run was interrupted or not. */
    void forget_positions() { discs = {}; }

    /** Where grains were when they were cut last [d][n] [m]: the same cut anew gives the same pieces, to the bit. */
    const grains::Components &position_of_cut() const { return discs.position; }

    /** Are the pieces those of @p grains where they are now, to the tolerance of the last cut? */
    bool is_cut_where(const grains::GrainArrays &grains) const;

    /** The pieces; their exchange terms are the time scheme's to fill. */
    fluid::InterphaseTerms<dim>       &terms() { return pieces.terms; }
    const fluid::InterphaseTerms<dim> &terms() const { return pieces.terms; }
    /** Index into the grain arrays, per piece. */
    const std::vector<unsigned int> &grain() const { return pieces.grain; }
    /** Per piece; empty unless the settings ask for it. */
    const std::vector<PieceArm> &arms() const { return pieces.arm; }
    bool                         keeps_arms() const { return cut_with.keep_arms; }

    /** As DiscCutter::is_non_tensor(). */
    bool is_non_tensor() const { return cutter.is_non_tensor(); }

    /** Of the ranks that share the cells. */
    MPI_Comm communicator() const { return space->communicator(); }

  private:
    /** Has @p g been moved from where its disc was cut? */
    bool has_moved(const grains::GrainArrays &grains, const std::size_t g) const;
    /** Bring the discs up to date but for their positions, which are empty if other things have changed. */
    std::vector<std::uint8_t> find_moved(const grains::GrainArrays &grains, const OverlapSettings &settings);
    /** Make the pieces of each grain add up to its volume. Collective. */
    void weigh(const grains::GrainArrays &grains);

    const fluid::FluidSpace<dim> *space;
    DiscCutter                    cutter;
    PieceList                     pieces;
    Discs                         discs;        // as they were cut; none: nothing is
    std::vector<double>           fluid_radius; // of the grains then [m]
    OverlapSettings               cut_with;
  };
} // namespace alluvium::coupling
