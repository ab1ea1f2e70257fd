#include <alluvium/fluid/field_transfer.h>

#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>

namespace alluvium::fluid
{
  using namespace dealii;

  template <int dim>
  class FieldTransfer<dim>::Implementation
  {
  public:
    const DoFHandler<dim> *system, *nodal;

    // deal.II packs the values while the mesh changes, so the originals must not be needed until then
    std::vector<BlockVector> old_blocks;
    std::vector<Vector>      old_nodal;

    std::unique_ptr<parallel::distributed::SolutionTransfer<dim, BlockVector>> block_transfer;
    std::unique_ptr<parallel::distributed::SolutionTransfer<dim, Vector>>      nodal_transfer;
  };


  template <int dim>
  FieldTransfer<dim>::FieldTransfer(const DoFHandler<dim> &system, const DoFHandler<dim> &nodal)
    : implementation(std::make_unique<Implementation>())
  {
    implementation->system = &system;
    implementation->nodal  = &nodal;
  }


  template <int dim>
  FieldTransfer<dim>::~FieldTransfer() = default;


  template <int dim>
  void FieldTransfer<dim>::prepare(const std::vector<const BlockVector *> &block_fields,
                                   const std::vector<const Vector *>      &nodal_fields)
  {
    Implementation &my = *implementation;
    my.old_blocks.clear();
    my.old_nodal.clear();
    std::vector<const BlockVector *> blocks;
    std::vector<const Vector *>      nodals;
    for (const BlockVector *field : block_fields)
      my.old_blocks.push_back(*field);
    for (const Vector *field : nodal_fields)
      my.old_nodal.push_back(*field);
    for (BlockVector &field : my.old_blocks)
      {
        field.update_ghost_values();
        blocks.push_back(&field);
      }
    for (Vector &field : my.old_nodal)
      {
        field.update_ghost_values();
        nodals.push_back(&field);
      }
    my.block_transfer.reset();
    my.nodal_transfer.reset();
    if (!blocks.empty())
      {
        my.block_transfer = std::make_unique<parallel::distributed::SolutionTransfer<dim, BlockVector>>(*my.system);
        my.block_transfer->prepare_for_coarsening_and_refinement(blocks);
      }
    if (!nodals.empty())
      {
        my.nodal_transfer = std::make_unique<parallel::distributed::SolutionTransfer<dim, Vector>>(*my.nodal);
        my.nodal_transfer->prepare_for_coarsening_and_refinement(nodals);
      }
  }


  template <int dim>
  void FieldTransfer<dim>::interpolate(const std::vector<BlockVector *> &block_fields,
                                       const AffineConstraints<double>  &hanging_constraints,
                                       const std::vector<Vector *>      &nodal_fields,
                                       const AffineConstraints<double>  &nodal_constraints)
  {
    Implementation &my = *implementation;
    AssertThrow(block_fields.size() == my.old_blocks.size() && nodal_fields.size() == my.old_nodal.size(),
                ExcInternalError());

    // the reading order must be that of prepare()
    if (my.block_transfer)
      {
        std::vector<BlockVector *> fields = block_fields;
        for (BlockVector *field : fields)
          field->zero_out_ghost_values();
        my.block_transfer->interpolate(fields);
      }
    if (my.nodal_transfer)
      {
        std::vector<Vector *> fields = nodal_fields;
        for (Vector *field : fields)
          field->zero_out_ghost_values();
        my.nodal_transfer->interpolate(fields);
      }
    for (BlockVector *field : block_fields)
      {
        hanging_constraints.distribute(*field);
        field->update_ghost_values();
      }
    for (Vector *field : nodal_fields)
      {
        nodal_constraints.distribute(*field);
        field->update_ghost_values();
      }
    my.block_transfer.reset();
    my.nodal_transfer.reset();
    my.old_blocks.clear();
    my.old_nodal.clear();
  }


  template class FieldTransfer<2>;
} // namespace alluvium::fluid
