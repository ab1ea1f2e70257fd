#include "fixtures/test_mesh.h"

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace
{
  using namespace dealii;
  using namespace alluvium;
  using namespace mesh_test;
  using mesh::Domain;

  const std::string data = std::string(ALLUVIUM_TEST_DATA);

  std::string content(const std::string &name)
  {
    std::ifstream      file(data + "/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  /** Replace the first @p from in @p text by @p to. */
  std::string replace(std::string text, const std::string &from, const std::string &to)
  {
    const auto position = text.find(from);
    EXPECT_NE(position, std::string::npos) << from;
    return text.replace(position, from.size(), to);
  }

  /** What the user is told about a mesh file with this @p text. */
  std::string complaint_about(const std::string &text)
  {
    // one file a rank: a rank must not remove what another still reads
    const std::string name =
      "alluvium_domain_test_" + std::to_string(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + ".msh";
    const auto path = std::filesystem::temp_directory_path() / name;
    std::ofstream(path) << text;
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Mesh file", name}});
    const std::string error =
      error_of([&] { domain.initialize(MPI_COMM_SELF, std::filesystem::temp_directory_path().string()); });
    std::filesystem::remove(path);
    EXPECT_TRUE(contains(error, name)) << error;
    return error;
  }

  double measure_of(const Triangulation<2> &mesh)
  {
    double sum = 0.;
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned())
        sum += cell->measure();
    return Utilities::MPI::sum(sum, mesh.get_communicator());
  }

  TEST(Domain, RectangleHasNamedBoundariesAndSquareCells)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Lower left corner", "-1, 2"}, {"Domain/Upper right corner", "2.03, 3.2"}});
    domain.initialize(MPI_COMM_WORLD, "");
    EXPECT_TRUE(domain.is_rectangle());
    EXPECT_FALSE(domain.has_triangles());

    const auto mesh = domain.make_triangulation(0.25);
    EXPECT_NEAR(measure_of(*mesh), 3.03 * 1.2, 1e-12);
    for (const auto &cell : mesh->active_cell_iterators())
      {
        const auto box = cell->bounding_box();
        EXPECT_LE(box.side_length(0), 0.25 * 1.02);
        EXPECT_NEAR(box.side_length(0) / box.side_length(1), 1., 0.05);
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              const auto        center = cell->face(f)->center();
              const std::string name   = center[0] == -1.                   ? "left"
                                         : center[1] == 2.                  ? "bottom"
                                         : std::abs(center[1] - 3.2) < 1e-9 ? "top"
                                                                            : "right";
              EXPECT_EQ(cell->face(f)->boundary_id(), domain.boundary_ids().at(name));
            }
      }
  }

  TEST(Domain, ThinRectangleHasSquareCells)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Upper right corner", "10, 1.2"}});
    domain.initialize(MPI_COMM_WORLD, "");
    const auto box = domain.make_triangulation(1.)->begin()->bounding_box();
    EXPECT_NEAR(box.side_length(0) / box.side_length(1), 1., 0.05);
  }

  TEST(Domain, RectangleThatIsNeverRefinedHasTheSameCellsAndIsCutAcrossItsBed)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Upper right corner", "1, 2"}});
    domain.initialize(MPI_COMM_WORLD, "");
    std::vector<double> x, y; // a bed in the lower half
    for (unsigned int j = 0; j < 32; ++j)
      for (unsigned int i = 0; i < 32; ++i)
        {
          x.push_back((i + 0.5) / 32.);
          y.push_back((j + 0.5) / 32.);
        }
    mesh::CellWeights weights;
    weights.count(x, y, 0.1);

    const auto curve    = domain.make_triangulation(1. / 16.),
               bisected = domain.make_triangulation(1. / 16., true, weights);
    EXPECT_NE(dynamic_cast<const parallel::shared::Triangulation<2> *>(bisected.get()), nullptr);
    EXPECT_EQ(curve->n_global_active_cells(), bisected->n_global_active_cells());
    auto         other   = curve->begin_active();
    const auto   n_ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    unsigned int n_owned = 0, n_in_bed = 0;
    for (const auto &cell : bisected->active_cell_iterators())
      {
        EXPECT_LT(cell->center().distance((other++)->center()), 1e-12);
        if (cell->is_locally_owned())
          {
            ++n_owned;
            n_in_bed += cell->center()[1] < 1.;
          }
      }
    EXPECT_EQ(n_owned * n_ranks, 16u * 32u);
    EXPECT_EQ(n_in_bed * n_ranks, 16u * 16u);
  }

  TEST(Domain, RectangleWallsCloseTheBoxExceptWhereOpen)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Upper right corner", "2, 1"}, {"Domain/Open to grains", "right, top"}});
    domain.initialize(MPI_COMM_WORLD, "");
    ASSERT_EQ(domain.walls().size(), 2u);
    EXPECT_EQ(domain.walls()[0].name, "left");
    EXPECT_EQ(domain.walls()[1].name, "bottom");
    EXPECT_EQ(domain.walls()[0].b, domain.walls()[1].a); // they share the corner to the bit
  }

  TEST(Domain, BadParametersAreReported)
  {
    const auto error = [](const std::vector<std::pair<std::string, std::string>> &values) {
      return error_of([&] {
        ParameterHandler prm;
        Domain<2>        domain;
        set_parameters(domain, prm, values);
        domain.initialize(MPI_COMM_WORLD, "");
      });
    };
    EXPECT_TRUE(
      contains(error({{"Domain/Upper right corner", "0, 1"}}), "Domain: the upper right corner must be above"));
    EXPECT_TRUE(contains(error({{"Domain/Open to grains", "topp"}}), "no boundary named 'topp'"));
    EXPECT_TRUE(contains(error({{"Domain/Mesh file", "/nowhere/mesh.msh"}}), "'/nowhere/mesh.msh' does not exist"));
    EXPECT_TRUE(contains(error({{"Domain/Mesh file", "/tmp"}}), "'/tmp' cannot be read"));
  }

  TEST(Domain, WithoutACellSizeItAsksForOne)
  {
    Domain<2> domain;
    domain.initialize(MPI_COMM_WORLD, "");
    EXPECT_TRUE(contains(error_of([&] { domain.make_triangulation(0.); }), "Coarse cell size"));
  }

  class MeshFile : public testing::TestWithParam<const char *>
  {
  };

  TEST_P(MeshFile, IsReadWithNamesBoxAndWalls)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Mesh file", std::string(GetParam()) + ".msh"}});
    domain.initialize(MPI_COMM_WORLD, data);
    const bool triangles = contains(GetParam(), "triangles");
    EXPECT_EQ(domain.has_triangles(), triangles);
    EXPECT_EQ(domain.boundary_ids().size(), 5u);
    EXPECT_NEAR(domain.lower().distance(Point<2>(0., 0.)), 0., 1e-12);
    EXPECT_NEAR(domain.upper().distance(Point<2>(1., 1.)), 0., 1e-12);

    // six straight sides, of which the step has two
    EXPECT_EQ(domain.walls().size(), 6u);
    double                     length = 0.;
    std::multiset<std::string> names;
    for (const auto &wall : domain.walls())
      {
        length += std::hypot(wall.b[0] - wall.a[0], wall.b[1] - wall.a[1]);
        names.insert(wall.name);
      }
    EXPECT_NEAR(length, 4., 1e-12);
    EXPECT_EQ(names, (std::multiset<std::string>{"floor", "outlet", "step", "step", "inlet", "back wall"}));

    const auto mesh = domain.make_triangulation(0.);
    EXPECT_NEAR(measure_of(*mesh), 0.75, 1e-12);
    EXPECT_EQ(mesh->all_reference_cells_are_simplex(), triangles);
    unsigned int n_owned = 0;
    for (const auto &cell : mesh->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          ++n_owned;
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary() && std::abs(cell->face(f)->center()[1]) < 1e-12)
              {
                EXPECT_EQ(cell->face(f)->boundary_id(), domain.boundary_ids().at("floor"));
              }
        }
    const double fair = double(mesh->n_global_active_cells()) / Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    EXPECT_NEAR(n_owned, fair, triangles ? 1. : 0.5 * fair);
  }

  INSTANTIATE_TEST_SUITE_P(Gmsh,
                           MeshFile,
                           testing::Values("triangles_22", "triangles_41", "quadrilaterals_22", "quadrilaterals_41"));

  TEST(Domain, BothFacesOfACrackAreWalls)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Mesh file", "crack_22.msh"}});
    domain.initialize(MPI_COMM_WORLD, ALLUVIUM_TEST_DATA);
    unsigned int n_faces = 0;
    for (const auto &wall : domain.walls())
      if (wall.name == "pile")
        {
          ++n_faces;
          EXPECT_EQ(std::abs(wall.b[1] - wall.a[1]), 0.5);
        }
    EXPECT_EQ(n_faces, 2u);
    for (const double x : {0., 0.3, 0.5, 0.7, 1.})
      for (const double y : {0., 0.3, 0.5, 0.7, 1.})
        EXPECT_TRUE(domain.contains(x, y)) << x << ' ' << y;
    EXPECT_FALSE(domain.contains(-0.1, 0.7));
    EXPECT_FALSE(domain.contains(1.1, 0.7));
    EXPECT_FALSE(domain.contains(0.5, 1.1));
  }

  TEST(Domain, ContainsWhatItsMeshCovers)
  {
    ParameterHandler prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Mesh file", "quadrilaterals_22.msh"}, {"Domain/Open to grains", "step"}});
    domain.initialize(MPI_COMM_WORLD, ALLUVIUM_TEST_DATA);
    EXPECT_TRUE(domain.contains(0.25, 0.75));
    EXPECT_TRUE(domain.contains(0.75, 0.25));
    EXPECT_TRUE(domain.contains(0.75, 0.5)); // on a side
    EXPECT_FALSE(domain.contains(0.75, 0.75));
    EXPECT_FALSE(domain.contains(0.75, 0.5001));
    EXPECT_FALSE(domain.contains(1.5, 0.25));
  }

  TEST(Domain, MeshFilesThatCannotBeUsedAreExplained)
  {
    const std::string v2 = content("triangles_22.msh"), v4 = content("triangles_41.msh");
    EXPECT_TRUE(contains(complaint_about(""), "is empty"));
    EXPECT_TRUE(contains(complaint_about("solid stl"), "no section $MeshFormat"));
    EXPECT_TRUE(contains(complaint_about(replace(v2, "2.2 0 8", "2.2 1 8")), "is binary"));
    EXPECT_TRUE(contains(complaint_about(replace(v4, "4.1 0 8", "3 0 8")), "has format 3"));
    EXPECT_TRUE(contains(complaint_about(replace(v4, "$PhysicalNames", "$PhysicalMames")), "no $PhysicalNames"));
    EXPECT_TRUE(contains(complaint_about(replace(v4, "\"outlet\"", "\"floor\"")), "two physical curves named 'floor'"));
    EXPECT_TRUE(
      contains(complaint_about(replace(v2, "1 2 \"outlet\"", "1 77 \"outlet\"")), ") is in no named physical curve"));
    EXPECT_TRUE(contains(complaint_about(v4.substr(0, v4.size() / 2)), "'"));
    EXPECT_TRUE(contains(complaint_about(v2.substr(0, v2.size() - 200)), "$Elements"));
    // a tetrahedron, a node out of the plane, a second-order triangle, and lines only
    const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"all\"\n$EndPhysicalNames\n";
    const std::string nodes    = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n";
    const auto        elements = [](const std::string &line) { return "$Elements\n1\n" + line + "\n$EndElements\n"; };
    EXPECT_TRUE(contains(complaint_about(head + nodes + elements("1 4 2 1 1 1 2 3 4")), "3-D mesh"));
    EXPECT_TRUE(contains(complaint_about(head + nodes + elements("1 9 2 1 1 1 2 3 4 4 4")), "only linear"));
    EXPECT_TRUE(contains(complaint_about(head + nodes + elements("1 1 2 1 1 1 2")), "Physical Surface"));
    EXPECT_TRUE(contains(complaint_about(head + replace(nodes, "4 1 1 0", "4 1 1 1") + elements("1 3 2 1 1 1 2 4 3")),
                         "not in the plane"));
    EXPECT_TRUE(
      contains(complaint_about(head + nodes + "$Elements\n2\n1 2 2 1 1 1 2 3\n2 3 2 1 1 1 2 4 3\n$EndElements\n"),
               "mixes triangles"));
    EXPECT_TRUE(
      contains(complaint_about(head + nodes + elements("1 2 2 1 1 1 2 77")), "node 77, which is not in $Nodes"));
  }

  TEST(Domain, DamagedMeshFilesAreRefused)
  {
    const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"all\"\n$EndPhysicalNames\n";
    const std::string nodes    = "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n$EndNodes\n";
    const auto        elements = [](const std::vector<std::string> &lines) {
      std::string text = "$Elements\n" + std::to_string(lines.size()) + "\n";
      for (std::size_t i = 0; i < lines.size(); ++i)
        text += std::to_string(i + 1) + " " + lines[i] + "\n";
      return text + "$EndElements\n";
    };
    const std::string a = "3 2 9 1 1 2 3 4", b = "3 2 9 1 2 5 6 3";
    const auto        about = [&](const std::vector<std::string> &lines) {
      return complaint_about(head + nodes + elements(lines));
    };
    EXPECT_TRUE(contains(about({a, b}), "is in no named physical curve"));
    EXPECT_TRUE(contains(about({a, "3 2 9 1 2 5 3 6"}), "not convex at (1.5, 0.5) m"));
    EXPECT_TRUE(contains(about({"2 2 9 1 1 2 5"}), "without area at (1, 0) m"));
    EXPECT_TRUE(contains(about({a, a}), "lie on one another"));
    EXPECT_TRUE(contains(about({"2 2 9 1 1 2 3", "2 2 9 1 1 2 4"}), "lie on one another"));
    EXPECT_TRUE(contains(about({a, b, "1 2 1 1 2 3"}), "physical curve 'all' inside the mesh, at (1, 0.5) m"));
    EXPECT_TRUE(contains(about({a, b, "1 2 1 1 1 3"}), "no side of a cell"));
    EXPECT_TRUE(contains(about({"2 2 9 1 1 2 4", "2 2 9 1 5 6 3"}), "not in one piece"));
    EXPECT_TRUE(contains(about({"3 2 9 1 1 2 2 4"}), "node 2 at two corners"));
    EXPECT_TRUE(contains(complaint_about(head + replace(nodes, "4 0 1 0", "3 0 1 0") + elements({a})), "node 3 twice"));
    EXPECT_TRUE(contains(complaint_about(replace(head, "1 1 ", "1 -1 ") + nodes + elements({a})), "tags are positive"));
    EXPECT_TRUE(contains(complaint_about(replace(head, "all", "\xff") + nodes + elements({a})), "not UTF-8"));
    EXPECT_TRUE(
      contains(complaint_about(head + replace(nodes, "$Nodes\n6", "$Nodes\n5") + elements({a})), "goes on with '6'"));
    // entities of format 4.1: what crashed deal.II's reader
    const std::string v4 = content("triangles_41.msh");
    const auto        at = v4.find("$Entities") + 10;
    for (const std::string count : {"-1", "99999999999", "1000", "x"})
      EXPECT_TRUE(contains(complaint_about(v4.substr(0, at) + count + v4.substr(v4.find(' ', at))), "$Entities"))
        << count;
  }
} // namespace
