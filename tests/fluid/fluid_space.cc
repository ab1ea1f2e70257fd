#include "fixtures/boundary_kinds.h"

#include "fixtures/test_mesh.h"

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/largest_speed.h>

#include <deal.II/base/mpi.h>

namespace
{
  using namespace alluvium;
  using namespace mesh_test;

  /** On the mesh of a file in tests/data, with walls all around. */
  struct SpaceOfMeshFile
  {
    dealii::ParameterHandler                     prm;
    mesh::Domain<2>                              domain;
    std::unique_ptr<dealii::Triangulation<2, 2>> triangulation;
    std::unique_ptr<fluid::FluidSpace<2>>        space;

    explicit SpaceOfMeshFile(const std::string &file)
    {
      set_parameters(domain, prm, {{"Domain/Mesh file", file}});
      domain.initialize(MPI_COMM_WORLD, std::string(ALLUVIUM_TEST_DATA));
      triangulation = domain.make_triangulation(0.);
      fluid::BoundaryConditions<2> boundary_conditions;
      for (const auto &[boundary, id] : domain.boundary_ids())
        boundary_conditions.set(id, {boundary_kinds::no_slip, boundary, nullptr});
      boundary_conditions.pin(true);
      space = std::make_unique<fluid::FluidSpace<2>>(*triangulation);
      space->reinit(boundary_conditions);
    }
  };

  /** The fluid's space on the meshes of a domain: the same on any number of ranks. */
  TEST(FluidSpaceOnDomain, TrianglesAndQuadrilateralsOfAMeshFile)
  {
    for (const std::string name : {"triangles_41", "quadrilaterals_41"})
      {
        const SpaceOfMeshFile       of_file(name + ".msh");
        const fluid::FluidSpace<2> &space         = *of_file.space;
        const auto                 &triangulation = of_file.triangulation;

        EXPECT_EQ(space.n_dofs(), 3 * space.nodal_dof_handler().n_dofs()) << name;
        EXPECT_EQ(space.nodal_dof_handler().n_dofs(), name == "triangles_41" ? triangulation->n_vertices() : 21u);
        fluid::Vector one = space.make_nodal_field();
        one               = 1.;
        EXPECT_NEAR(space.node_volumes() * one, 0.75, 1e-12) << name;
        // 5 for components of 3 and 4
        fluid::BlockVector field = space.make_field();
        for (unsigned int i = 0; i < field.block(0).locally_owned_size(); ++i)
          field.block(0).local_element(i) = i % 2 == 0 ? -3. : 4.;
        field.update_ghost_values();
        EXPECT_NEAR(fluid::largest_speed(space, field.block(0)), 5., 1e-12) << name;
        const auto n_cells =
          dealii::Utilities::MPI::sum(static_cast<unsigned int>(space.cells().size()), MPI_COMM_WORLD);
        EXPECT_EQ(n_cells, triangulation->n_global_active_cells()) << name;
      }
  }

  /** A field of another mesh, of which the rank owned the same range by chance, gets the ghosts of this one. */
  TEST(FluidSpaceOnDomain, FieldsOfAnotherMeshGetItsGhosts)
  {
    const SpaceOfMeshFile       of_file("quadrilaterals_41.msh");
    const fluid::FluidSpace<2> &space          = *of_file.space;
    const auto                  without_ghosts = [](const fluid::Vector &field) {
      return fluid::Vector(field.locally_owned_elements(), field.get_mpi_communicator());
    };
    fluid::Vector      nodal = without_ghosts(space.make_nodal_field());
    fluid::BlockVector field(2);
    for (unsigned int b = 0; b < 2; ++b)
      field.block(b) = without_ghosts(space.make_field().block(b));
    space.reinit_nodal_field(nodal);
    space.reinit_field(field);
    EXPECT_EQ(nodal.get_partitioner(), space.make_nodal_field().get_partitioner());
    for (unsigned int b = 0; b < 2; ++b)
      EXPECT_EQ(field.block(b).get_partitioner(), space.make_field().block(b).get_partitioner());
  }
} // namespace
