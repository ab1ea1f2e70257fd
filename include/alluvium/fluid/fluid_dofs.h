#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_block_vector.h>

#include <array>
#include <memory>
#include <vector>

namespace alluvium::fluid
{
  /** Block 0: velocity [m/s], interleaved components; block 1: reduced pressure p - rho g.x [Pa]. */
  using BlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;
  using Vector      = dealii::LinearAlgebra::distributed::Vector<double>;

  /** A rectangle that repeats itself where its length is not 0 [m]. */
  template <int dim>
  struct PeriodicBox
  {
    std::array<double, dim> lower{}, length{};
  };

  /**
   * The unknowns of an equal-order linear velocity-pressure space on a mesh of quadrilaterals (with hanging nodes) or
   * triangles, those of a scalar nodal field beside them, and what ties them together: hanging nodes, periodicity.
   */
  template <int dim>
  class FluidDofs
  {
  public:
    /** Live on @p triangulation, which must outlive this. Throws UserError for mixed cell types. */
    void attach(const dealii::Triangulation<dim> &triangulation);

    /**
     * Let the fields be periodic from the next reinit() on. The mesh must be a rectangle with deal.II's colours as
     * boundary ids, and know of its periodicity itself.
     */
    void                    set_periodic_box(const PeriodicBox<dim> &periodic_box) { box = periodic_box; }
    const PeriodicBox<dim> &periodic_box() const { return box; }

    /** Number the unknowns anew, for the mesh as it is. Collective. */
    void reinit();

    BlockVector make_field() const;       // ghosted, zero
    Vector      make_nodal_field() const; // scalar, ghosted, zero

    /**
     * The same for a field that there is, of this mesh or an earlier one. An assignment would not do: deal.II's vectors
     * keep their old ghosts if the rank happens to own the same range of indices as before.
     */
    void reinit_field(BlockVector &field) const;
    void reinit_nodal_field(Vector &field) const;

    /** Fill a nodal field's hanging nodes by interpolation. */
    void interpolate_hanging_nodes(Vector &nodal_field) const;

    const dealii::Triangulation<dim> &triangulation() const { return *tria; }
    bool                              has_triangles() const;
    const dealii::Mapping<dim>       &mapping() const { return *map; }
    const dealii::DoFHandler<dim>    &dof_handler() const { return dofs; }
    const dealii::DoFHandler<dim>    &nodal_dof_handler() const { return nodal_dofs; }
    /** @p cell, which belongs to dof_handler(), as nodal_dof_handler() sees it. */
    typename dealii::DoFHandler<dim>::active_cell_iterator
    nodal_cell(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell) const
    {
      return {tria, cell->level(), cell->index(), &nodal_dofs}; // deal.II has a function for it only from 9.5 on
    }
    unsigned int                    n_nodes_per_cell() const { return n_nodes; }
    dealii::types::global_dof_index n_dofs() const { return dofs.n_dofs(); }
    dealii::types::global_dof_index first_pressure() const { return partitioners[0]->size(); }
    MPI_Comm                        communicator() const { return tria->get_communicator(); }

    /** Hanging nodes and periodicity, of all unknowns and of a nodal field. */
    const dealii::AffineConstraints<double> &hanging_constraints() const { return hanging; }
    const dealii::AffineConstraints<double> &nodal_constraints() const { return nodal_hanging; }

    const std::vector<dealii::IndexSet> &owned() const { return owned_blocks; }
    const std::vector<dealii::IndexSet> &relevant() const { return relevant_blocks; }
    const dealii::IndexSet              &relevant_dofs() const { return relevant_all; }

    /** Which unknowns of a block, or of a nodal field, this rank owns and knows. */
    const dealii::Utilities::MPI::Partitioner &partitioner(const unsigned int block) const
    {
      return *partitioners[block];
    }
    const dealii::Utilities::MPI::Partitioner &nodal_partitioner() const { return *nodal; }

  private:
    /** Renumber both handlers: nodes near each other, velocities as their nodes, all pressures after them. */
    void number_by_nodes();
    void make_periodic(const dealii::DoFHandler<dim> &handler, dealii::AffineConstraints<double> &constraints) const;

    const dealii::Triangulation<dim>           *tria = nullptr;
    PeriodicBox<dim>                            box;
    std::unique_ptr<dealii::Mapping<dim>>       map;
    std::unique_ptr<dealii::FiniteElement<dim>> scalar_fe, system_fe;
    dealii::DoFHandler<dim>                     dofs, nodal_dofs;
    dealii::AffineConstraints<double>           hanging, nodal_hanging;
    std::vector<dealii::IndexSet>               owned_blocks, relevant_blocks;
    dealii::IndexSet                            relevant_all;
    unsigned int                                n_nodes = 0;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner>              nodal;
    std::vector<std::shared_ptr<const dealii::Utilities::MPI::Partitioner>> partitioners;
  };
} // namespace alluvium::fluid
