#pragma once

#include <alluvium/fluid/field_transfer.h>

#include <string>
#include <vector>

namespace dealii
{
  template <int, int>
  class Triangulation;
}

namespace alluvium::fluid
{
  /**
   * The fluid's mesh and fields in a folder, to go on from with the same bits and with any number of ranks. A mesh
   * that may be refined is saved by p4est with the fields attached to its cells; for one that never changes, which all
   * ranks know, the fields go by vertex. `fluid.manifest` lists the files with their sizes and checksums. It is written
   * last: without it there is no checkpoint.
   *
   * Loading takes two steps, because the caller has to build the space in between:
   *
   *   mesh = domain.make_triangulation(...);  checkpoint.load_mesh(*mesh);
   *   space.reinit(...);                      checkpoint.load_fields(space.dof_handler(), {&old},
   * space.nodal_dof_handler(), {});
   *
   * All functions are collective and throw UserError on all ranks.
   */
  template <int dim>
  class FluidCheckpoint
  {
  public:
    /** Files are in @p folder, which exists. */
    explicit FluidCheckpoint(const std::string &folder);

    /** Save the mesh of the DoFHandlers and these fields, with ghosts as FluidSpace makes them. An older one there is
     * overwritten. */
    void save(const dealii::DoFHandler<dim, dim>     &system,
              const std::vector<const BlockVector *> &block_fields,
              const dealii::DoFHandler<dim, dim>     &nodal,
              const std::vector<const Vector *>      &nodal_fields) const;

    /**
     * Check all files, then refine @p triangulation, which is unrefined, as it was. Throws UserError if a file is
     * missing, cut off or altered, or if the checkpoint was made with another unrefined mesh.
     */
    void load_mesh(dealii::Triangulation<dim, dim> &triangulation);

    /** Fill fields as many as were saved, in the same order; ghosts are up to date afterwards. After load_mesh(). */
    void load_fields(const dealii::DoFHandler<dim, dim> &system,
                     const std::vector<BlockVector *>   &block_fields,
                     const dealii::DoFHandler<dim, dim> &nodal,
                     const std::vector<Vector *>        &nodal_fields) const;

  private:
    std::string  file(const std::string &name) const;
    std::string  folder;
    unsigned int n_block_fields = 0, n_nodal_fields = 0; // in the checkpoint loaded
  };
} // namespace alluvium::fluid
