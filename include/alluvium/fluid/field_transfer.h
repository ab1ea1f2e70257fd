#pragma once

#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

namespace dealii
{
  template <int, int>
  class DoFHandler;
  template <typename>
  class AffineConstraints;
} // namespace dealii

namespace alluvium::fluid
{
  using BlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;
  using Vector      = dealii::LinearAlgebra::distributed::Vector<double>;

  /**
   * Carries finite element fields over one change of a distributed mesh: interpolation in refined cells, nodal values
   * in joined ones (what a joined cell held between its vertices is lost). The DoFHandlers stay, and are redistributed
   * in between:
   *
   *   transfer.prepare(...);  mesh.execute_coarsening_and_refinement();  space.reinit(...);  transfer.interpolate(...);
   */
  template <int dim>
  class FieldTransfer
  {
  public:
    /** Block fields live on @p system, scalar nodal fields on @p nodal. Both are kept by reference. */
    FieldTransfer(const dealii::DoFHandler<dim, dim> &system, const dealii::DoFHandler<dim, dim> &nodal);
    ~FieldTransfer();

    /**
     * Take copies of the fields, ghosted as FluidSpace makes them. Collective; the mesh must change next, and
     * interpolate() must follow.
     */
    void prepare(const std::vector<const BlockVector *> &block_fields,
                 const std::vector<const Vector *>      &nodal_fields = {});

    /**
     * Fill new fields, as many as prepare() got and in its order, initialised for the new mesh by the caller. Hanging
     * nodes come from the constraints, which must hold nothing else; ghosts are up to date afterwards.
     */
    void interpolate(const std::vector<BlockVector *>        &block_fields,
                     const dealii::AffineConstraints<double> &hanging_constraints,
                     const std::vector<Vector *>             &nodal_fields,
                     const dealii::AffineConstraints<double> &nodal_constraints);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium::fluid
