#pragma once

#include <alluvium/utilities/checked_file.h>

#include <deal.II/base/types.h>

#include <string>
#include <vector>

namespace dealii
{
  template <int, int>
  class Triangulation;
}

namespace alluvium::mesh
{
  /**
   * Which rank owns which cell. A restart on as many ranks takes it over: grains have moved since the mesh was
   * partitioned, and another partition has other round-off.
   */
  struct Partition
  {
    unsigned int                             n_ranks = 0;
    std::vector<dealii::types::subdomain_id> owners;     // of the cells of a mesh that all ranks have
    std::vector<std::string>                 last_cells; // else of each rank that has cells, in the forest's order

    /** That of @p mesh as it is. Collective. */
    static Partition of(const dealii::Triangulation<2, 2> &mesh);

    /**
     * Make it that of a distributed @p mesh with the same cells, whose weight signal must be unconnected; fields must
     * have been made ready for the change. Collective.
     */
    void apply(dealii::Triangulation<2, 2> &mesh) const;

    void save(ByteWriter &writer) const;
    void load(ByteReader &reader); // throws std::runtime_error if that is none
  };
} // namespace alluvium::mesh
