#include "fixtures/test_mesh.h"
#include "fixtures/test_space.h"

#include <alluvium/fluid/fluid_checkpoint.h>
#include <alluvium/mesh/partition.h>
#include <alluvium/refinement/adaptivity.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace
{
  using namespace dealii;
  using namespace alluvium;
  using namespace alluvium::fluid;
  using namespace alluvium::mesh;
  using namespace mesh_test;

  /** Something that no interpolation reproduces by chance. */
  class Waves : public Function<2>
  {
  public:
    explicit Waves(const unsigned int n_components)
      : Function<2>(n_components)
    {}
    double value(const Point<2> &p, const unsigned int component) const override
    {
      return std::sin(13. * p[0] + component) * std::cos(17. * p[1] * p[0]);
    }
  };

  TEST(Partition, OfOtherRanksIsNoPartition)
  {
    for (const unsigned int owner : {2u, 3u, 0xffffffffu})
      {
        Partition partition;
        partition.n_ranks = 3;
        partition.owners  = {0, owner, 1};
        ByteWriter writer;
        partition.save(writer);
        ByteReader reader(writer.bytes);
        if (owner < 3)
          EXPECT_NO_THROW(partition.load(reader));
        else
          EXPECT_THROW(partition.load(reader), std::runtime_error);
      }
  }

  /** A mesh with fields on the ranks of one communicator. */
  struct FluidRun
  {
    FluidRun(const MPI_Comm communicator, const bool triangles, const double cell_size = 0.125)
    {
      set_parameters(domain,
                     prm,
                     triangles
                       ? std::vector<std::pair<std::string, std::string>>{{"Domain/Mesh file", "triangles_41.msh"}}
                       : std::vector<std::pair<std::string, std::string>>{});
      domain.initialize(communicator, std::string(ALLUVIUM_TEST_DATA));
      mesh = domain.make_triangulation(cell_size);
    }

    void refine_somewhere()
    {
      for (unsigned int round = 0; round < 3; ++round)
        {
          for (const auto &cell : mesh->active_cell_iterators())
            if (cell->is_locally_owned() && cell->center().norm() < 0.5)
              cell->set_refine_flag();
          mesh->execute_coarsening_and_refinement();
        }
    }

    void make_fields()
    {
      space = std::make_unique<Space>(*mesh);
      u     = space->field();
      p     = space->nodal_field();
    }

    void set_fields()
    {
      make_fields();
      for_each_support_point([&](const Point<2> &x, const unsigned int component, const types::global_dof_index dof) {
        u(dof) = Waves(3).value(x, component);
      });
      for (const auto &cell : space->nodal_dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            if (const auto dof = cell->vertex_dof_index(v, 0); space->nodal_dofs.locally_owned_dofs().is_element(dof))
              p(dof) = Waves(1).value(cell->vertex(v), 0);
      u.update_ghost_values();
      p.update_ghost_values();
    }

    template <typename Function>
    void for_each_support_point(const Function &function)
    {
      for (const auto &cell : space->dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int c = 0; c < 3; ++c)
              if (const auto dof = cell->vertex_dof_index(v, c); space->dofs.locally_owned_dofs().is_element(dof))
                function(cell->vertex(v), c, dof);
    }

    /** Are all values those of set_fields(), to the bit? */
    void expect_fields()
    {
      unsigned int n_wrong = 0;
      for_each_support_point([&](const Point<2> &x, const unsigned int component, const types::global_dof_index dof) {
        n_wrong += u(dof) != Waves(3).value(x, component);
      });
      for (const auto &cell : space->nodal_dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            n_wrong += p(cell->vertex_dof_index(v, 0)) != Waves(1).value(cell->vertex(v), 0);
      EXPECT_EQ(n_wrong, 0u);
      EXPECT_TRUE(u.has_ghost_elements());
    }

    void save(const std::string &folder) const
    {
      FluidCheckpoint<2>(folder).save(space->dofs, {&u}, space->nodal_dofs, {&p});
    }

    void load(const std::string &folder)
    {
      FluidCheckpoint<2> checkpoint(folder);
      checkpoint.load_mesh(*mesh);
      make_fields();
      checkpoint.load_fields(space->dofs, {&u}, space->nodal_dofs, {&p});
    }

    ParameterHandler                  prm;
    Domain<2>                         domain;
    std::unique_ptr<Triangulation<2>> mesh;
    std::unique_ptr<Space>            space;
    fluid::BlockVector                u;
    fluid::Vector                     p;
  };

  /** A folder of this test, the same on all ranks, and a communicator of one of them. */
  class Checkpoint : public testing::TestWithParam<bool>
  {
  protected:
    void SetUp() override
    {
      const int pid = Utilities::MPI::broadcast(MPI_COMM_WORLD, int(getpid()));
      path          = std::filesystem::temp_directory_path() / ("alluvium_fluid_" + std::to_string(pid));
      if (first)
        std::filesystem::create_directories(path);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    void TearDown() override
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (first)
        std::filesystem::remove_all(path);
      MPI_Barrier(MPI_COMM_WORLD);
    }

    const bool            first     = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    const bool            triangles = GetParam();
    std::filesystem::path path;
  };

  TEST_P(Checkpoint, IsExactOnAsManyRanksAndOnFewerAndOnMore)
  {
    unsigned long long n_cells = 0;
    {
      FluidRun run(MPI_COMM_WORLD, triangles);
      if (!triangles)
        run.refine_somewhere();
      run.set_fields();
      run.save(path.string());
      run.save(path.string()); // twice: over an old one
      n_cells = run.mesh->n_global_active_cells();
    }
    {
      FluidRun run(MPI_COMM_WORLD, triangles);
      run.load(path.string());
      EXPECT_EQ(run.mesh->n_global_active_cells(), n_cells);
      run.expect_fields();
    }
    MPI_Barrier(MPI_COMM_WORLD);
    if (first)
      {
        FluidRun run(MPI_COMM_SELF, triangles);
        run.load(path.string());
        EXPECT_EQ(run.mesh->n_global_active_cells(), n_cells);
        run.expect_fields();
        run.save(path.string()); // now one by a single rank
      }
    MPI_Barrier(MPI_COMM_WORLD);
    FluidRun run(MPI_COMM_WORLD, triangles);
    run.load(path.string());
    EXPECT_EQ(run.mesh->n_global_active_cells(), n_cells);
    run.expect_fields();
    // and the mesh goes on living
    if (!triangles)
      {
        run.refine_somewhere();
        EXPECT_GT(run.mesh->n_global_active_cells(), n_cells);
      }
  }

  TEST_P(Checkpoint, DamageIsNoticed)
  {
    {
      FluidRun run(MPI_COMM_WORLD, triangles);
      if (!triangles)
        run.refine_somewhere();
      run.set_fields();
      run.save(path.string());
    }
    MPI_Barrier(MPI_COMM_WORLD);
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(path))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    MPI_Barrier(MPI_COMM_WORLD); // before the first rank adds files
    EXPECT_GE(files.size(), triangles ? 2u : 4u);

    const auto complaint = [&] {
      MPI_Barrier(MPI_COMM_WORLD);
      FluidRun   run(MPI_COMM_WORLD, triangles);
      const auto text = error_of([&] { run.load(path.string()); });
      MPI_Barrier(MPI_COMM_WORLD);
      return text;
    };
    for (const auto &file : files)
      {
        const auto copy = file.string() + "~";
        if (first)
          {
            std::filesystem::rename(file, copy);
            std::filesystem::copy(copy, file);
            std::filesystem::resize_file(file, std::filesystem::file_size(copy) - 3);
          }
        EXPECT_TRUE(contains(complaint(), file.string()));
        if (first)
          {
            std::filesystem::remove(file);
            std::filesystem::copy(copy, file);
            std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
            f.seekg(std::filesystem::file_size(copy) / 2);
            const char c = f.peek();
            f.seekp(std::filesystem::file_size(copy) / 2);
            f.put(c ^ 1);
          }
        EXPECT_TRUE(contains(complaint(), file.string()));
        if (first)
          std::filesystem::remove(file);
        EXPECT_TRUE(contains(complaint(), file.string()));
        if (first)
          std::filesystem::rename(copy, file);
        MPI_Barrier(MPI_COMM_WORLD);
      }

    if (!triangles)
      {
        FluidRun other(MPI_COMM_WORLD, false, 0.25);
        EXPECT_TRUE(contains(error_of([&] { other.load(path.string()); }), "another unrefined mesh"));
      }
    FluidRun healed(MPI_COMM_WORLD, triangles);
    healed.load(path.string());
    healed.expect_fields();
    EXPECT_TRUE(contains(error_of([&] { healed.save((path / "nowhere").string()); }), "does not exist"));
  }

  INSTANTIATE_TEST_SUITE_P(Meshes, Checkpoint, testing::Bool(), [](const auto &info) {
    return info.param ? "Triangles" : "Quadrilaterals";
  });
} // namespace
