#pragma once

#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/boundary_nodes.h>
#include <alluvium/fluid/interphase.h>
#include <alluvium/geometry/boundary_part.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_block_vector.h>

namespace alluvium::fluid
{
  /** Block 0: velocity [m/s], interleaved components; block 1: reduced pressure p - rho g.x [Pa]. */
  using BlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;
  using Vector      = dealii::LinearAlgebra::distributed::Vector<double>;

  /**
   * What the assembly needs of one locally owned cell, computed once a mesh. Local indices address ghosted vectors
   * directly (Vector::local_element), which a loop over dof handlers and FEValues could not do as fast.
   */
  template <int dim>
  struct CellData
  {
    static constexpr unsigned int n = max_nodes<dim>;

    double                                                measure, size; // [m^dim], [m]
    std::array<std::array<std::array<double, dim>, n>, n> grad;          // [quadrature point][node]
    std::array<double, n>                                 jxw;
    std::array<std::array<unsigned int, dim>, n>          velocity; // local indices in block 0
    std::array<unsigned int, n>                           pressure; // in block 1
    std::array<unsigned int, n>                           node;     // in scalar nodal fields
    std::array<dealii::Point<dim>, n>                     vertex;
    std::array<dealii::types::global_dof_index, n *(dim + 1)>
         dofs;          // global; [node * (dim+1) + component], component dim: p
    bool constrained;   // does any dof carry a constraint?
    bool parallelogram; // or a triangle: the map from the reference cell is affine, its inverse's gradients are
    std::array<std::array<double, dim>, dim> to_reference; // [reference coordinate][direction] [1/m]
  };

  /**
   * Equal-order linear velocity-pressure space on a mesh of quadrilaterals (with hanging nodes) or triangles, with its
   * constraints, its boundary dofs and the cached geometry of its cells. Rebuilt when the mesh changes.
   */
  template <int dim>
  class FluidSpace
  {
  public:
    FluidSpace() = default;
    explicit FluidSpace(const dealii::Triangulation<dim> &triangulation) { attach(triangulation); }

    /** Live on @p triangulation, which must outlive this. Throws UserError for mixed cell types. */
    void attach(const dealii::Triangulation<dim> &triangulation);

    /** A rectangle that repeats itself where its length is not 0 [m]. */
    struct PeriodicBox
    {
      std::array<double, dim> lower{}, length{};
    };

    /**
     * Let the fields be periodic from the next reinit() on. The mesh must be a rectangle with deal.II's colours as
     * boundary ids, and know of its periodicity itself.
     */
    void               set_periodic_box(const PeriodicBox &periodic_box) { box = periodic_box; }
    const PeriodicBox &periodic_box() const { return box; }

    /** Let parts of sides be boundaries of their own from the next reinit() on. */
    void set_boundary_parts(const std::vector<geometry::BoundaryPart> &boundary_parts) { parts = boundary_parts; }

    /** What boundaries the face from @p a to @p b of the side @p id consists of. */
    std::vector<geometry::FacePart>
    divide_face(const dealii::types::boundary_id id, const dealii::Point<dim> &a, const dealii::Point<dim> &b) const;

    /** Number the dofs anew; call after the mesh or the kinds of boundary conditions changed. */
    void reinit(const BoundaryConditions<dim> &boundary_conditions);

    const std::vector<CellData<dim>> &cells() const { return cell_data; }
    unsigned int                      n_nodes_per_cell() const { return n_nodes; }
    unsigned int                      n_q_points() const { return n_q; }
    /** Shape values [quadrature point][node], the same on every cell. */
    const std::array<std::array<double, max_nodes<dim>>, max_nodes<dim>> &shape_values() const { return shapes; }

    BlockVector make_field() const;       // ghosted, zero
    Vector      make_nodal_field() const; // scalar, ghosted, zero

    /**
     * The same for a field that there is, of this mesh or an earlier one. An assignment would not do: deal.II's vectors
     * keep their old ghosts if the rank happens to own the same range of indices as before.
     */
    void reinit_field(BlockVector &field) const;
    void reinit_nodal_field(Vector &field) const;

    /** Velocities of the fluid by nodal dof [m/s]. */
    using GivenVelocities = std::map<dealii::types::global_dof_index, dealii::Tensor<1, dim>>;

    /**
     * Set @p field's boundary values at the time of @p boundary_conditions, then its hanging nodes. The reduced
     * pressure is p - rho g.x - @p datum, with @p hydrostatic_gradient = rho g, less what @p deficits say of its
     * boundary (none if that is not among them) [Pa]. @p velocities are those of the nodes at which they are given.
     */
    void apply_boundary_values(const BoundaryConditions<dim>                      &boundary_conditions,
                               const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                               const double                                        datum,
                               const std::map<dealii::types::boundary_id, double> &deficits,
                               const GivenVelocities                              &velocities,
                               BlockVector                                        &field) const;

    /** Has @p field these boundary values already, to the last bit? Collective. */
    bool has_boundary_values(const BoundaryConditions<dim>                      &boundary_conditions,
                             const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                             const double                                        datum,
                             const std::map<dealii::types::boundary_id, double> &deficits,
                             const GivenVelocities                              &velocities,
                             const BlockVector                                  &field) const;

    /**
     * The prescribed p - rho g.x at one node, the same on all ranks: a datum that spares the linear solver large
     * constants. Zero if no boundary has a pressure. Collective.
     */
    double pressure_datum(const BoundaryConditions<dim> &boundary_conditions,
                          const dealii::Tensor<1, dim>  &hydrostatic_gradient) const;

    const dealii::Triangulation<dim> &triangulation() const { return *tria; }
    const dealii::Mapping<dim>       &mapping() const { return *map; }
    const dealii::DoFHandler<dim>    &dof_handler() const { return dofs; }
    const dealii::DoFHandler<dim>    &nodal_dof_handler() const { return nodal_dofs; }
    /** @p cell, which belongs to dof_handler(), as nodal_dof_handler() sees it. */
    typename dealii::DoFHandler<dim>::active_cell_iterator
    nodal_cell(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell) const
    {
      return {tria, cell->level(), cell->index(), &nodal_dofs}; // deal.II has a function for it only from 9.5 on
    }
    dealii::types::global_dof_index n_dofs() const { return dofs.n_dofs(); }
    MPI_Comm                        communicator() const { return tria->get_communicator(); }

    /** Hanging nodes and boundary conditions, all homogeneous (for increments); hanging nodes alone. */
    const dealii::AffineConstraints<double> &constraints() const { return system_constraints; }
    const dealii::AffineConstraints<double> &hanging_constraints() const { return hanging; }
    const dealii::AffineConstraints<double> &nodal_constraints() const { return nodal_hanging; }

    const std::vector<dealii::IndexSet> &owned() const { return owned_blocks; }
    const std::vector<dealii::IndexSet> &relevant() const { return relevant_blocks; }
    const dealii::IndexSet              &relevant_dofs() const { return relevant_all; }

    /**
     * A test function that is 1 on the nodes of one boundary and 0 on all others, on the cells where it does not
     * vanish; at nodes where boundaries with a given pressure meet, it is what they share. The residual of the
     * continuity equation against it is the flux through that boundary, with what is given on others around.
     */
    struct BoundaryWeight
    {
      unsigned int                       cell;
      std::array<double, max_nodes<dim>> weight;
    };
    const std::vector<BoundaryWeight> &weights_at(const dealii::types::boundary_id id) const
    {
      return boundary_weights.at(id);
    }

    /** Of all cells that this rank knows. */
    const std::vector<InflowFace<dim>>                               &inflow_faces() const { return inflow; }
    const std::map<dealii::types::global_dof_index, InflowNode<dim>> &inflow_nodes() const { return inflow_at; }
    const std::vector<OpenFace<dim>>                                 &open_faces() const { return open; }
    /** Ids of the boundaries with a given pressure, in order, the same on all ranks. */
    const std::vector<dealii::types::boundary_id> &open_boundaries() const { return open_ids; }

    /** Fill a nodal field's hanging nodes by interpolation. */
    void interpolate_hanging_nodes(Vector &nodal_field) const;

    /** Integral of each nodal basis function [m^dim], hanging nodes condensed. */
    const Vector &node_volumes() const { return volumes; }

  private:
    /** Call @p action(block, index in the block, value) for all locally owned boundary values. */
    template <typename Action>
    void for_each_boundary_value(const BoundaryConditions<dim>                      &boundary_conditions,
                                 const dealii::Tensor<1, dim>                       &hydrostatic_gradient,
                                 const double                                        datum,
                                 const std::map<dealii::types::boundary_id, double> &deficits,
                                 const GivenVelocities                              &velocities,
                                 const Action                                       &action) const;
    /** Renumber both handlers: nodes near each other, velocities as their nodes, all pressures after them. */
    void number_by_nodes();
    void make_periodic(const dealii::DoFHandler<dim> &handler, dealii::AffineConstraints<double> &constraints) const;
    void make_constraints(const BoundaryConditions<dim> &boundary_conditions);
    void cache_cells();

    const dealii::Triangulation<dim>           *tria = nullptr;
    PeriodicBox                                 box;
    std::vector<geometry::BoundaryPart>         parts;
    std::unique_ptr<dealii::Mapping<dim>>       map;
    std::unique_ptr<dealii::FiniteElement<dim>> scalar_fe, system_fe;
    dealii::DoFHandler<dim>                     dofs, nodal_dofs;
    dealii::AffineConstraints<double>           system_constraints, hanging, nodal_hanging;
    std::vector<dealii::IndexSet>               owned_blocks, relevant_blocks;
    dealii::IndexSet                            relevant_all;

    unsigned int                                                   n_nodes = 0, n_q = 0;
    std::array<std::array<double, max_nodes<dim>>, max_nodes<dim>> shapes;
    std::vector<CellData<dim>>                                     cell_data;
    Vector                                                         volumes;

    std::vector<PrescribedDof<dim>>                                   boundary_dofs;
    std::map<dealii::types::boundary_id, std::vector<BoundaryWeight>> boundary_weights;
    std::vector<InflowFace<dim>>                                      inflow;
    std::map<dealii::types::global_dof_index, InflowNode<dim>>        inflow_at;
    std::vector<OpenFace<dim>>                                        open;
    std::vector<dealii::types::boundary_id>                           open_ids;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner>              nodal_partitioner;
    std::vector<std::shared_ptr<const dealii::Utilities::MPI::Partitioner>> partitioners;
  };
} // namespace alluvium::fluid
