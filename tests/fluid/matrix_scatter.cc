// Cells' matrices that go to addresses found once make the same matrix as those that go through the constraints.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/matrix_scatter.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/block_sparsity_pattern.h>

#include <gtest/gtest.h>

#include <random>

namespace
{
  using namespace dealii;
  using namespace alluvium::fluid;

  template <std::size_t n>
  using Local = std::array<std::array<double, n>, n>;

  void make(const FluidSpace<2> &space, TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    BlockDynamicSparsityPattern pattern(space.relevant());
    DoFTools::make_sparsity_pattern(space.dof_handler(), pattern, space.constraints(), true);
    matrix.reinit(space.owned(), pattern, space.communicator());
  }

  template <std::size_t n>
  void expect_same_matrix(const Triangulation<2> &mesh, const bool has_hanging_nodes)
  {
    BoundaryConditions<2> bc;
    for (unsigned int id = 0; id < 4; ++id)
      bc.set(id, {boundary_kinds::no_slip, "side", nullptr});
    bc.pin(true);
    FluidSpace<2> space(mesh);
    space.reinit(bc);
    TrilinosWrappers::BlockSparseMatrix by_address, by_constraints;
    make(space, by_address);
    make(space, by_constraints);
    MatrixScatter<2> scatter;
    scatter.reinit(space, by_address);
    scatter.find_values(by_address);

    std::mt19937                           random(1);
    std::uniform_real_distribution<double> number(-1., 1.);
    unsigned int                           n_served = 0;
    for (unsigned int i = 0; i < space.cells().size(); ++i)
      {
        if (!scatter.serves(i))
          continue;
        ++n_served;
        Local<n>                             local;
        FullMatrix<double>                   full(n, n);
        std::vector<types::global_dof_index> dofs(n);
        for (unsigned int r = 0; r < n; ++r)
          {
            dofs[r] = space.cells()[i].dofs[r];
            for (unsigned int c = 0; c < n; ++c)
              full(r, c) = local[r][c] = number(random);
          }
        scatter.add(i, local);
        space.constraints().distribute_local_to_global(full, dofs, by_constraints);
      }
    by_address.compress(VectorOperation::add);
    by_constraints.compress(VectorOperation::add);
    EXPECT_GT(n_served, 0u);
    EXPECT_LT(n_served, space.cells().size()); // those at walls and at hanging nodes are not
    EXPECT_EQ(space.hanging_constraints().n_constraints() > 0, has_hanging_nodes);
    const double norm = by_constraints.frobenius_norm();
    EXPECT_GT(norm, 1.);
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int b = 0; b < 2; ++b)
        {
          by_address.block(a, b).add(-1., by_constraints.block(a, b));
          EXPECT_LT(by_address.block(a, b).frobenius_norm(), 1e-14 * norm) << a << b;
        }
  }
} // namespace

TEST(MatrixScatter, Quadrilaterals)
{
  Triangulation<2> mesh;
  GridGenerator::subdivided_hyper_cube(mesh, 6, 0., 1., true);
  expect_same_matrix<12>(mesh, false);
}

TEST(MatrixScatter, HangingNodes)
{
  Triangulation<2> mesh;
  GridGenerator::subdivided_hyper_cube(mesh, 8, 0., 1., true);
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->center()[0] < 0.5)
      cell->set_refine_flag();
  mesh.execute_coarsening_and_refinement();
  expect_same_matrix<12>(mesh, true);
}

TEST(MatrixScatter, Triangles)
{
  Triangulation<2> quadrilaterals, mesh;
  GridGenerator::subdivided_hyper_cube(quadrilaterals, 5, 0., 1., true);
  GridGenerator::convert_hypercube_to_simplex_mesh(quadrilaterals, mesh);
  expect_same_matrix<9>(mesh, false);
}
