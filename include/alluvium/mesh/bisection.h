#pragma once

#include <alluvium/mesh/cell_weights.h>

#include <deal.II/base/point.h>
#include <deal.II/distributed/shared_tria.h>

#include <vector>

namespace alluvium::mesh
{
  /** What bisection knows of a cell. */
  struct BisectedCell
  {
    dealii::Point<2> center; // [m]
    double           n_near; // grains that are likely to be cut by it
  };

  /**
   * Partition @p cells into @p n_parts by recursive coordinate bisection, along x or y: always where the
   * larger share of the cells and the larger share of the grains near them, which may be the other half's, together
   * cost least. Ranks wait for one another between cutting grains and solving, so both are to be even, not their sum;
   * of two cuts about as good, the one across the longer side is taken. Returns the part of each cell; no part is empty
   * unless there are more of them than cells.
   */
  std::vector<dealii::types::subdomain_id> bisect(const std::vector<BisectedCell> &cells, unsigned int n_parts);

  /** Partition the active cells of @p triangulation, and the grains that @p weights counts near them, over all ranks.
   */
  void partition_by_bisection(dealii::parallel::shared::Triangulation<2> &triangulation, const CellWeights &weights);
} // namespace alluvium::mesh
