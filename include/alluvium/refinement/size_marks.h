#pragma once

#include <alluvium/refinement/refinement_criterion.h>
#include <alluvium/refinement/size_raster.h>

namespace alluvium::refinement
{
  /** The box around one of the fluid's cells. */
  mesh::Box box_around(const fluid::CellData<2> &cell, const unsigned int n_nodes);

  /**
   * What the criteria have in common that want small cells in and around certain places: how far the wish reaches and
   * how the size grows farther away, for refinement and for coarsening.
   */
  class SizeMarks
  {
  public:
    /** Declare how far marks reach, with @p half_width diameters as the default. */
    void add_parameters(dealii::ParameterHandler &prm, const double half_width);

    /** Forget all marks; get ready for those of @p context. */
    void clear(const RefinementContext &context);

    /** Want at most @p size [m] in and around @p box; let go only where less than that would do. */
    void add(const mesh::Box &box, const double size);

    /** Want at most @p size [m] in and around @p box if @p value is above @p threshold; let go below that. */
    void add_if_above(const double value, const double threshold, const mesh::Box &box, const double size);

    /** All marks of this rank are there. Collective. */
    void finish(const MPI_Comm communicator);

    double wanted_size(const mesh::Box &box, const Purpose purpose) const
    {
      return raster[purpose == Purpose::refine ? 0 : 1].smallest_in(box);
    }

  private:
    void stamp(const mesh::Box &box, const double size, const Purpose purpose);

    double                    half_width = 2., growth = 0.5, diameter = 0.;
    std::array<SizeRaster, 2> raster;
  };
} // namespace alluvium::refinement
