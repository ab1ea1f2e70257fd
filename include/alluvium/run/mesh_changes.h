#pragma once

#include <alluvium/mesh/partition.h>

#include <memory>

namespace dealii
{
  template <int, int>
  class Triangulation;
}

namespace alluvium::run
{
  struct Model;

  /** Give @p model this mesh, and make its fluid's space, fields at rest and coupling for it. Collective. */
  void attach_mesh(Model &model, std::unique_ptr<dealii::Triangulation<2, 2>> mesh);

  /** Deal the cells of a distributed mesh out as @p partition says, with the fields as they are. Collective. */
  void repartition(Model &model, const mesh::Partition &partition);

  /** Count the grains near each cell anew, for the next partition of the mesh. */
  void count_cell_weights(Model &model);

  /**
   * Adapt the mesh to the grains and fields as they are, carry the fields over, and, once the run has begun,
   * re-initialise them. True if the mesh has changed. Collective.
   */
  bool adapt_mesh(Model &model);
} // namespace alluvium::run
