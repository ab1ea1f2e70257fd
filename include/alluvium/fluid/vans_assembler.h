#pragma once

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/matrix_scatter.h>
#include <alluvium/fluid/vans_problem.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>

namespace alluvium::fluid
{
  /**
   * Assembles the stabilised weak form for increments around an iterate x that already has its boundary values:
   *   A dx = r(x) = known terms - A x,  with homogeneous constraints.
   * Momentum: eps rho (du/dt + u.grad u) and eps eta (grad u + grad u^T) on the mesh, -grad p + sum over pieces A grad
   * p (model A), drag on the pieces. Continuity integrated by parts. PSPG and SUPG with the full residual, pieces
   * included, and tau = [(2 rho eps/dt)^2 + (2 rho eps |u|/h)^2 + (12 eps eta/h^2)^2 + (2 sigma)^2]^(-1/2), sigma the
   * cell's mean drag.
   */
  template <int dim>
  class VansAssembler
  {
  public:
    explicit VansAssembler(const FluidSpace<dim> &space);

    /** Build the sparsity pattern; call after every FluidSpace::reinit(). */
    void reinit();

    /** Fill matrix(), @p residual = r(@p iterate), and the part of it that known_interphase() gives. */
    void
    assemble(const VansProblem<dim> &problem, const BlockVector &iterate, BlockVector &residual, BlockVector &known);

    /** The pieces' known terms (a, e, u_ref): all that a change of the lagged field changes. */
    void known_interphase(const VansProblem<dim> &problem, BlockVector &known) const;

    /**
     * Flux of the mixture out through boundary @p id [m^2/s], from the continuity equation's own residual: what enters
     * minus what leaves is then zero to the solver's tolerance. Collective.
     */
    double
    flux(const VansProblem<dim> &problem, const BlockVector &solution, const dealii::types::boundary_id id) const;

    /**
     * Sum over all nodes of what the pieces put into the momentum equation [N/m]: minus the sum of the forces on the
     * grains, if the third law holds. Collective.
     */
    std::array<double, dim> interphase_force(const VansProblem<dim> &problem, const BlockVector &solution) const;

    /**
     * The moment of the same about the origin [N], in two dimensions. Streamline-upwind weights let a piece act
     * upstream of where it is: only without convection is it minus the grains' torque. Collective.
     */
    double interphase_torque(const VansProblem<dim> &problem, const BlockVector &solution) const;

    const dealii::TrilinosWrappers::BlockSparseMatrix &matrix() const { return system_matrix; }
    dealii::TrilinosWrappers::BlockSparseMatrix       &matrix() { return system_matrix; }

    /** Sizes of the two equations' terms before they cancel (l2 over cells and nodes): what a residual is small
     * against. */
    std::array<double, 2> term_norms(const VansProblem<dim> &problem, const BlockVector &iterate) const;

  private:
    const FluidSpace<dim>                      *space;
    dealii::TrilinosWrappers::BlockSparseMatrix system_matrix;
    MatrixScatter<dim>                          scatter;
  };
} // namespace alluvium::fluid
