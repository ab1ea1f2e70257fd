#pragma once

#include <alluvium/mesh/cell_weights.h>
#include <alluvium/refinement/refinement_criterion.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/point.h>

#include <array>
#include <functional>
#include <vector>

namespace dealii
{
  template <int, int>
  class Triangulation;
}

namespace alluvium::refinement
{
  /** Corners of a quadrilateral, in deal.II's order: lower left and right, upper left and right [m]. */
  template <int dim>
  using CellCorners = std::array<dealii::Point<dim>, 1 << dim>;

  /** What an adaptation did, and the mesh after it. The same on all ranks. */
  struct AdaptationReport
  {
    bool               changed   = false;
    bool               satisfied = true;  // no cell larger than wanted
    bool               limited   = false; // cells stayed too large because of `Max cells` or `Max levels`
    unsigned int       n_rounds  = 0;     // of refinement and coarsening
    unsigned long long n_cells   = 0;
    double             share     = 0.;              // of the domain's area, where cells were refined or joined
    double             smallest = 0., largest = 0.; // cell sizes [m]
  };

  /**
   * Refines and coarsens the fluid's mesh so that every cell is at most as large as the criteria want. The size of a
   * cell is its diagonal over sqrt(dim), a square's side. A family of cells is joined only if their parent, widened by
   * a margin, would still be small enough: the mesh does not flutter while the bed does.
   */
  template <int dim>
  class Adaptivity
  {
  public:
    /** Declare section `Mesh refinement` in @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** After the file was read; see Plugin. Throws UserError. */
    void parse_parameters();

    /**
     * The cell size [m] that the unrefined mesh should have, or 0 if the criteria cannot say because there are no
     * grains.
     */
    double coarse_size(const RefinementContext &context) const;

    /** Are cells of @p size [m], all of them, what the criteria want in the whole run? Then they are never refined. */
    bool never_refines(const double size, const RefinementContext &context) const;

    /** Whether the mesh is adapted after the start. */
    bool adapts() const { return interval > 0; }

    /** Is the mesh to be adapted before step number @p step (0, 1, ...)? */
    bool due(unsigned int step) const;

    /** What to warn of: a criterion that wants smaller cells everywhere than `Finest cell size` lets it have; or empty.
     */
    std::string remark_on_limits(const RefinementContext &context) const;

    /** Throws UserError if a criterion will want what is no size in the run to @p end_time [s]. */
    void check_until(double end_time, const RefinementContext &context) const;

    /** Does a criterion look at the fluid's fields? Then a mesh may change although no grain moves. */
    bool needs_fluid() const;

    /**
     * Refine the mesh of t = 0 until all criteria are met. Throws UserError if that takes more than `Max cells`, or if
     * there are in the end fewer cells than ranks. Triangles stay as they are, and are to meet the criteria by
     * themselves (see `satisfied`). Collective.
     */
    AdaptationReport make_initial_mesh(dealii::Triangulation<dim, dim> &triangulation,
                                       const RefinementContext         &context) const;

    /**
     * Adapt the mesh during the run. Each round of refinement and coarsening is `before()`, the mesh changes,
     * `after()`; neither is called if nothing is to change. Typically with a FieldTransfer:
     *
     *   adapt(mesh, context, [&] { transfer.prepare({&old}); },
     *                        [&] { space.reinit(bc); space.reinit_field(old);
     *                              transfer.interpolate({&old}, space.hanging_constraints(), {},
     * space.nodal_constraints()); });
     *
     * At `Max cells` nothing is refined any further, which the report says. Triangles stay as they are. Collective.
     */
    AdaptationReport adapt(dealii::Triangulation<dim, dim> &triangulation,
                           const RefinementContext         &context,
                           const std::function<void()>     &before,
                           const std::function<void()>     &after) const;

    /**
     * Let @p weights, asked at each change, decide how many cells each rank gets; they must outlive the mesh. What
     * is never refined stays where it is.
     */
    static void balance(dealii::Triangulation<dim, dim> &triangulation, const mesh::CellWeights &weights);

    /**
     * Throws UserError if the parameters ask for adaptation of a mesh of triangles, which is impossible: `Interval`
     * must be 0 there.
     */
    void check_mesh(const dealii::Triangulation<dim, dim> &triangulation) const;

    /** The parameter `Max cells`. */
    double most_cells() const { return max_cells; }

    /**
     * About how many cells the criteria make of unrefined @p cells, each of which stands for @p weight of them. Found
     * without making any, level by level; where there are many, a part of them stands for all. Cells that are refined
     * for their neighbours' sake, or because of the flow, are not counted.
     */
    double expected_cells(std::vector<CellCorners<dim>> cells, double weight, const RefinementContext &context) const;

    /** Throws UserError if @p n_cells of expected_cells() are too many, beyond its error. */
    void check_number(double n_cells) const;

  private:
    AdaptationReport run(dealii::Triangulation<dim, dim> &triangulation,
                         const RefinementContext         &context,
                         const std::function<void()>     &before,
                         const std::function<void()>     &after,
                         bool                             initial) const;

    double wanted_size(const mesh::Box &box, const RefinementContext &context, Purpose purpose) const;

    PluginChoice<RefinementCriterion> criteria;
    double                            coarsest = 8., finest = 0.25, margin = 0.25; // in d; in d; in cells
    unsigned int                      interval = 50, max_levels = 10;
    double                            max_cells = 2e6;
  };
} // namespace alluvium::refinement
