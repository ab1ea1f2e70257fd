#include <alluvium/contacts/grain_checkpoint.h>
#include <alluvium/grains/grain_columns.h>
#include <alluvium/grains/grain_store.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>
#include <deal.II/particles/particle_handler.h>

#include <gtest/gtest.h>

#include <algorithm>
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
      grains.id[i] = i;
    for_each_column(grains, [&](std::vector<double> &values, const GrainColumn &) {
      for (double &value : values)
        value = uniform();
    });
    for (double &r : grains.radius)
      r = radius * (0.8 + 0.2 * r);
    return grains;
  }

  void expect_equal(const GrainArrays &a, const GrainArrays &b)
  {
    EXPECT_EQ(a.id, b.id);
    for (const GrainColumn &column : grain_columns)
      for (unsigned int c = 0; c < column.n_components; ++c)
        EXPECT_EQ(column.values(a, c), column.values(b, c)) << column.name << ' ' << c;
  }

  /** Every grain is a particle on one rank, and has there all that the arrays say, in the cell around it. */
  void expect_particles_follow(GrainStore &store)
  {
    const auto         &particles = store.particles();
    const auto         &grains    = store.grains();
    std::vector<double> found(grains.n(), 0.);
    for (const auto &particle : particles)
      {
        const std::size_t i =
          std::lower_bound(grains.id.begin(), grains.id.end(), particle.get_id()) - grains.id.begin();
        ASSERT_LT(i, grains.n());
        found[i] += 1.;
        unsigned int p = 0;
        for (const GrainColumn &column : grain_columns)
          for (unsigned int c = 0; c < column.n_components; ++c)
            if (std::string(column.name) == "position")
              {
                EXPECT_EQ(particle.get_location()[c], column.values(grains, c)[i]);
              }
            else
              {
                EXPECT_EQ(particle.get_properties()[p++], column.values(grains, c)[i]) << column.name;
              }
        EXPECT_TRUE(particle.get_surrounding_cell()->is_locally_owned());
      }
    dealii::Utilities::MPI::sum(found, MPI_COMM_WORLD, found);
    EXPECT_EQ(found, std::vector<double>(grains.n(), 1.));
  }

  struct Store : GrainStore
  {
    Store(const GrainArrays &grains, const double height = 1., const double skin = 0.002)
      : GrainStore(MPI_COMM_WORLD)
    {
      this->grains() = grains;
      initialize({{0., 0.}}, {{1., height}}, skin);
    }
  };

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

  TEST(GrainStore, ParticlesAreWhatTheArraysSay)
  {
    Store store(make_grains(1000));
    expect_particles_follow(store);
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 2)
      {
        EXPECT_GT(store.n_local_particles(), 300u);
      }
    expect_equal(store.grains(), make_grains(1000));
  }

  // The grid goes with the grains, not with the box over their diameter squared.
  TEST(GrainStore, FewGrainsInAWideBox)
  {
    for (const double radius : {1e-2, 1e-4, 1e-7, 1e-15, 1e-30})
      for (const double height : {1., 1e-3})
        {
          auto grains = make_grains(3, radius);
          for (double &y : grains.position[1])
            y *= height;
          Store store(grains, height, 0.1 * radius);
          for (const auto &particle : store.particles())
            EXPECT_LE(particle.get_surrounding_cell()->get_triangulation().n_global_active_cells(), 4096u);
          expect_particles_follow(store);
          for (double &x : store.grains().position[0])
            x = 1. - x;
          expect_particles_follow(store);
        }
  }

  TEST(GrainStore, ParticlesFollowMotionOverManySteps)
  {
    Store store(make_grains(2000));
    auto &grains = store.grains();
    for (unsigned int step = 0; step < 50; ++step)
      {
        // a vortex: grains go from rank to rank
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            const double dx = grains.position[0][i] - 0.5, dy = grains.position[1][i] - 0.5, angle = 0.1;
            grains.position[0][i] = std::min(1., std::max(0., 0.5 + std::cos(angle) * dx - std::sin(angle) * dy));
            grains.position[1][i] = std::min(1., std::max(0., 0.5 + std::sin(angle) * dx + std::cos(angle) * dy));
            grains.velocity[0][i] = step + i;
          }
        if (step % 3 == 0) // not asked for in each step
          store.particles();
      }
    expect_particles_follow(store);
  }

  TEST(GrainStore, KeepsGrainsThatJumpFarOrSitOnVertices)
  {
    Store store(make_grains(400, 0.05), 1., 0.);
    auto &grains = store.grains();
    // cells are of size 1.2 / 12 or near it; sweep positions on multiples of many fractions, vertices among them
    const double lower = 0. - 0.1, upper = 1.1;
    for (const unsigned int n : {4, 8, 10, 11, 12, 13, 16, 24})
      {
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            grains.position[0][i] = lower + (upper - lower) * ((7 * i) % (n + 1)) / n;
            grains.position[1][i] = lower + (upper - lower) * ((11 * i + 3) % (n + 1)) / n;
            for (auto &x : grains.position)
              x[i] = std::min(1.05, std::max(-0.05, x[i]));
          }
        expect_particles_follow(store);
      }
  }

  TEST(GrainStore, FollowsALoneJump)
  {
    Store store(make_grains(300));
    for (const double position : {0.01, 0.99, 0.5})
      {
        store.grains().position[0][7] = position;
        store.grains().position[1][7] = 1. - position;
        expect_particles_follow(store);
        EXPECT_EQ(store.particles().n_global_particles(), 300u);
      }
    store.grains().position[0][7] = 0.9;
    store.particles();
    EXPECT_EQ(store.n_rescued(), 1u);
  }

  // Those that have left are no particles any more, those that come are.
  TEST(GrainStore, FollowsOtherGrains)
  {
    Store store(make_grains(300));
    store.particles();
    store.grains() = make_grains(200);
    expect_particles_follow(store);
    EXPECT_EQ(store.particles().n_global_particles(), 200u);
    store.grains() = make_grains(250);
    expect_particles_follow(store);
  }

  TEST(GrainStore, NamesALostGrain)
  {
    Store store(make_grains(100), 1., 0.);
    auto &x                 = store.grains().position;
    x[1][42]                = -3.;
    const std::string error = error_of<UserError>([&] { store.check_positions(0.); });
    EXPECT_TRUE(contains(error, "Grain 42")) << error;
    EXPECT_TRUE(contains(error, "-3) m")) << error;
    x[1][42] = 0.5;
    x[0][17] = std::nan("");
    EXPECT_TRUE(contains(error_of<UserError>([&] { store.check_positions(0.); }), "Grain 17"));
    x[0][17]                       = -3.; // farther than its radius in a step
    store.grains().velocity[0][17] = -1e3;
    EXPECT_TRUE(contains(error_of<Divergence>([&] { store.check_positions(1.); }), "Grain 17"));
    x[0][17] = 0.1;
    store.check_positions(1.);
    store.let_leave(true);
    x[0][17] = 7.;
    store.check_positions(1.);
    EXPECT_EQ(store.particles().n_global_particles(), 100u);
  }

  TEST(GrainStore, CanBeEmptyOrTiny)
  {
    Store none(make_grains(0), 1., 0.);
    EXPECT_EQ(none.particles().n_global_particles(), 0u);
    Store one(make_grains(1, 0.5), 1., 0.1); // as large as the domain
    expect_particles_follow(one);
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
    Store store(make_grains(100), 1., 0.);
    store.output([&](auto &data) { data.write_vtu_in_parallel(file("grains.vtu"), MPI_COMM_WORLD); });
    MPI_Barrier(MPI_COMM_WORLD);
    std::ifstream      in(file("grains.vtu"), std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    for (const std::string name : {"id", "radius", "displacement", "velocity", "angular_velocity", "contact_force"})
      EXPECT_TRUE(contains(text.str(), "Name=\"" + name + "\"")) << name;
    for (const GrainColumn &column : grain_columns)
      EXPECT_EQ(contains(text.str(), "Name=\"" + std::string(column.name) + "\""), column.in_pictures) << column.name;
    EXPECT_TRUE(contains(text.str(), "Name=\"velocity\" NumberOfComponents=\"3\""));
    EXPECT_TRUE(contains(text.str(), "</VTKFile>"));
  }
} // namespace
