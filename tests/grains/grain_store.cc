#include <alluvium/contacts/grain_checkpoint.h>
#include <alluvium/grains/grain_store.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>
#include <deal.II/particles/particle_handler.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <unistd.h>

namespace
{
  using namespace alluvium;
  using namespace alluvium::contacts;
  using namespace alluvium::grains;

  /** @p n grains at random in the unit square, every number of theirs different. */
  GrainArrays make_grains(const std::size_t n, const double radius = 0.01)
  {
    std::mt19937_64 random(7);
    const auto      uniform = [&] { return (random() >> 11) * 0x1p-53; };
    GrainArrays     grains;
    grains.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      {
        grains.id[i]     = i;
        grains.radius[i] = radius * (0.8 + 0.2 * uniform());
        for (auto *v : {&grains.x,
                        &grains.y,
                        &grains.fluid_radius,
                        &grains.mass,
                        &grains.vx,
                        &grains.vy,
                        &grains.omega,
                        &grains.fcx,
                        &grains.fcy,
                        &grains.x0,
                        &grains.y0})
          (*v)[i] = uniform();
      }
    return grains;
  }

  std::vector<const std::vector<double> *> arrays(const GrainArrays &g)
  {
    return {&g.x, &g.y, &g.radius, &g.fluid_radius, &g.mass, &g.vx, &g.vy, &g.omega, &g.fcx, &g.fcy, &g.x0, &g.y0};
  }

  void expect_equal(const GrainArrays &a, const GrainArrays &b)
  {
    EXPECT_EQ(a.id, b.id);
    for (std::size_t k = 0; k < arrays(a).size(); ++k)
      EXPECT_EQ(*arrays(a)[k], *arrays(b)[k]) << "array " << k;
  }

  std::size_t n_on_all_ranks(const GrainStore &store)
  {
    return dealii::Utilities::MPI::sum(static_cast<unsigned long long>(store.n_local_grains()), MPI_COMM_WORLD);
  }

  template <typename Error, typename Function>
  std::string error_of(const Function &function)
  {
    try
      {
        function();
      }
    catch (const Error &error)
      {
        return error.what();
      }
    ADD_FAILURE() << "expected an error";
    return "";
  }

  bool contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }

  TEST(GrainStore, GivesBackWhatItGotToTheBit)
  {
    const auto grains = make_grains(1000);
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.002);
    EXPECT_EQ(store.n_grains(), 1000u);
    EXPECT_EQ(n_on_all_ranks(store), 1000u);
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 2)
      {
        EXPECT_GT(store.n_local_grains(), 300u);
      }
    expect_equal(store.gather(), grains);
  }

  // The grid goes with the grains, not with the box over their diameter squared.
  TEST(GrainStore, FewGrainsInAWideBox)
  {
    for (const double radius : {1e-2, 1e-4, 1e-7, 1e-15, 1e-30})
      for (const double height : {1., 1e-3})
        {
          auto grains = make_grains(3, radius);
          for (double &y : grains.y)
            y *= height;
          GrainStore store(MPI_COMM_WORLD);
          store.initialize(grains, {{0., 0.}}, {{1., height}}, 0.1 * radius);
          for (const auto &particle : store.particles())
            EXPECT_LE(particle.get_surrounding_cell()->get_triangulation().n_global_active_cells(), 4096u);
          expect_equal(store.gather(), grains);
          for (double &x : grains.x)
            x = 1. - x;
          store.scatter(grains);
          expect_equal(store.gather(), grains);
        }
  }

  TEST(GrainStore, FollowsMotionOverManySteps)
  {
    auto       grains = make_grains(2000);
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.002);
    for (unsigned int step = 0; step < 50; ++step)
      {
        // a vortex: grains go from rank to rank
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            const double dx = grains.x[i] - 0.5, dy = grains.y[i] - 0.5, angle = 0.1;
            grains.x[i]  = std::min(1., std::max(0., 0.5 + std::cos(angle) * dx - std::sin(angle) * dy));
            grains.y[i]  = std::min(1., std::max(0., 0.5 + std::sin(angle) * dx + std::cos(angle) * dy));
            grains.vx[i] = step + i;
          }
        store.scatter(grains);
        if (step == 25)
          store.rebalance();
      }
    EXPECT_EQ(n_on_all_ranks(store), 2000u);
    expect_equal(store.gather(), grains);
  }

  TEST(GrainStore, KeepsGrainsThatJumpFarOrSitOnVertices)
  {
    auto       grains = make_grains(400, 0.05);
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.);
    // cells are of size 1.2 / 12 or near it; sweep positions on multiples of many fractions, vertices among them
    const double lower = 0. - 0.1, upper = 1.1;
    for (const unsigned int n : {4, 8, 10, 11, 12, 13, 16, 24})
      {
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            grains.x[i] = lower + (upper - lower) * ((7 * i) % (n + 1)) / n;
            grains.y[i] = lower + (upper - lower) * ((11 * i + 3) % (n + 1)) / n;
            grains.x[i] = std::min(1.05, std::max(-0.05, grains.x[i]));
            grains.y[i] = std::min(1.05, std::max(-0.05, grains.y[i]));
          }
        store.scatter(grains);
        expect_equal(store.gather(), grains);
      }
  }

  TEST(GrainStore, FollowsALoneJump)
  {
    auto       grains = make_grains(300);
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.002);
    for (const double position : {0.01, 0.99, 0.5})
      {
        grains.x[7] = position;
        grains.y[7] = 1. - position;
        store.scatter(grains);
        EXPECT_EQ(n_on_all_ranks(store), 300u);
        EXPECT_EQ(store.particles().n_global_particles(), 300u);
        expect_equal(store.gather(), grains);
      }
    EXPECT_EQ(store.n_rescued(), 1u);
  }

  TEST(GrainStore, NamesALostGrain)
  {
    auto       grains = make_grains(100);
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.);
    grains.y[42]            = -3.;
    const std::string error = error_of<std::runtime_error>([&] { store.scatter(grains); });
    EXPECT_TRUE(contains(error, "Grain 42")) << error;
    EXPECT_TRUE(contains(error, "-3) m")) << error;
    grains.y[42] = 0.5;
    grains.x[17] = std::nan("");
    EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { store.scatter(grains); }), "Grain 17"));
    // the store is as before
    grains.x[17] = 0.1;
    store.scatter(grains);
    expect_equal(store.gather(), grains);
  }

  TEST(GrainStore, RebalancesAHeapInOneCorner)
  {
    auto grains = make_grains(2000);
    for (std::size_t i = 0; i < grains.n(); ++i)
      {
        grains.x[i] *= 0.2;
        grains.y[i] *= 0.2;
      }
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(grains, {{0., 0.}}, {{1., 1.}}, 0.002);
    store.rebalance();
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    EXPECT_NEAR(
      store.n_local_grains(), 2000. / n_ranks, 0.3 * 2000. / n_ranks); // p4est keeps families of four together
    expect_equal(store.gather(), grains);
    store.scatter(grains);
    expect_equal(store.gather(), grains);
  }

  TEST(GrainStore, CanBeEmptyOrTiny)
  {
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(make_grains(0), {{0., 0.}}, {{1., 1.}}, 0.);
    EXPECT_EQ(store.gather().n(), 0u);
    store.scatter(make_grains(0));
    store.rebalance();
    const auto one = make_grains(1, 0.5); // as large as the domain
    store.initialize(one, {{0., 0.}}, {{1., 1.}}, 0.1);
    expect_equal(store.gather(), one);
  }

  /** A folder of this test, the same on all ranks, removed at its end. */
  class Folder : public testing::Test
  {
  protected:
    void SetUp() override
    {
      const int pid = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, int(getpid()));
      path          = std::filesystem::temp_directory_path() / ("alluvium_grains_" + std::to_string(pid));
      if (first)
        std::filesystem::create_directories(path);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    void TearDown() override
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (first)
        std::filesystem::remove_all(path);
    }
    std::string file(const std::string &name) const { return (path / name).string(); }

    const bool            first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    std::filesystem::path path;
  };

  using GrainFiles = Folder;

  TEST_F(GrainFiles, CheckpointIsExactAndDamageIsNoticed)
  {
    const auto     grains = make_grains(500);
    ContactArchive contacts;
    contacts.dt             = 1e-4;
    contacts.wall_positions = {0.1, 0.2, 0.3, 0.4, 0.5, 1. / 3.};
    for (unsigned int i = 0; i < 700; ++i)
      contacts.entries.push_back({i, i % 3 ? i + 1 : ~1u, i % 3 == 0, i % 2 == 0, i / 7., -i / 13., i / 17.});
    const auto name = file("grains.bin");
    save_grains(MPI_COMM_WORLD, name, grains, contacts);

    GrainArrays    read;
    ContactArchive read_contacts;
    load_grains(MPI_COMM_WORLD, name, read, read_contacts);
    expect_equal(read, grains);
    EXPECT_EQ(read_contacts.dt, contacts.dt);
    EXPECT_EQ(read_contacts.wall_positions, contacts.wall_positions);
    ASSERT_EQ(read_contacts.entries.size(), contacts.entries.size());
    for (std::size_t i = 0; i < contacts.entries.size(); ++i)
      {
        const auto &a = contacts.entries[i], &b = read_contacts.entries[i];
        EXPECT_TRUE(a.a == b.a && a.b == b.b && a.wall == b.wall && a.bonded == b.bonded && a.rn == b.rn &&
                    a.rt == b.rt && a.rr == b.rr);
      }

    const auto complaint = [&] {
      MPI_Barrier(MPI_COMM_WORLD);
      const auto text = error_of<UserError>([&] { load_grains(MPI_COMM_WORLD, name, read, read_contacts); });
      MPI_Barrier(MPI_COMM_WORLD);
      EXPECT_TRUE(contains(text, name)) << text;
      return text;
    };
    if (first)
      {
        std::fstream f(name, std::ios::in | std::ios::out | std::ios::binary);
        f.seekp(3000);
        f.put('x');
      }
    EXPECT_TRUE(contains(complaint(), "checksum"));
    if (first)
      std::filesystem::resize_file(name, 5000);
    EXPECT_TRUE(contains(complaint(), "cut off"));
    if (first)
      std::filesystem::resize_file(name, 0);
    EXPECT_TRUE(contains(complaint(), "damaged"));
    if (first)
      std::filesystem::remove(name);
    EXPECT_TRUE(contains(complaint(), "cannot be opened"));
    EXPECT_TRUE(
      contains(error_of<UserError>([&] { save_grains(MPI_COMM_WORLD, file("no/such/folder.bin"), grains, contacts); }),
               "no/such"));
  }

  TEST_F(GrainFiles, ParaviewOutputHasAllFields)
  {
    GrainStore store(MPI_COMM_WORLD);
    store.initialize(make_grains(100), {{0., 0.}}, {{1., 1.}}, 0.);
    store.write_vtu(file("grains.vtu"));
    MPI_Barrier(MPI_COMM_WORLD);
    std::ifstream      in(file("grains.vtu"), std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    for (const std::string name : {"id", "radius", "displacement", "velocity", "angular_velocity", "contact_force"})
      EXPECT_TRUE(contains(text.str(), "Name=\"" + name + "\"")) << name;
    EXPECT_TRUE(contains(text.str(), "vtkZLibDataCompressor"));
    EXPECT_TRUE(contains(text.str(), "Name=\"velocity\" NumberOfComponents=\"3\""));
    EXPECT_TRUE(contains(text.str(), "</VTKFile>"));
  }
} // namespace
