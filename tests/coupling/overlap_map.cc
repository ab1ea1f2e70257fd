#include <alluvium/coupling/void_fraction.h>

#include "bed.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace
{
  using namespace bed;

  /** The pieces of @p grains, cut at once. */
  coupling::OverlapMap cut_at_once(const fluid::FluidSpace<2>      &space,
                                   const grains::GrainArrays       &grains,
                                   const coupling::OverlapSettings &settings)
  {
    coupling::OverlapMap map(space);
    map.reinit();
    map.cut(grains, settings);
    return map;
  }

  void expect_same(const coupling::OverlapMap &a, const coupling::OverlapMap &b)
  {
    ASSERT_EQ(a.terms().begin, b.terms().begin);
    ASSERT_EQ(a.grain(), b.grain());
    for (std::size_t k = 0; k < a.grain().size(); ++k)
      {
        EXPECT_EQ(a.terms().shape[k].area, b.terms().shape[k].area);
        EXPECT_EQ(a.terms().shape[k].phi, b.terms().shape[k].phi);
      }
    ASSERT_EQ(a.arms().size(), b.arms().size());
    for (std::size_t k = 0; k < a.arms().size(); ++k)
      {
        EXPECT_EQ(a.arms()[k].arm, b.arms()[k].arm);
        EXPECT_EQ(a.arms()[k].moments, b.arms()[k].moments);
      }
  }

  /** Some grains move a little, far, or across a periodic boundary; the rest keeps its pieces. */
  void keeps_what_stands(const bool periodic, const coupling::OverlapSettings &rule)
  {
    Bed      bed = random_bed(1, 20., 10.);
    Settings settings;
    settings.periodic = periodic;
    Channel              channel(bed.width, bed.height, bed.d, settings, 0.);
    coupling::OverlapMap map(channel.space);
    map.reinit();
    EXPECT_TRUE(map.cut(bed.grains, rule));
    EXPECT_FALSE(map.cut(bed.grains, rule));

    std::mt19937                           random(7);
    std::uniform_real_distribution<double> uniform(0., 1.);
    auto                                  &g = bed.grains;
    for (unsigned int round = 0; round < 3; ++round)
      {
        for (unsigned int k = 0; k < 5; ++k)
          {
            const auto i     = static_cast<std::size_t>(uniform(random) * g.n());
            g.position[0][i] = round == 2 && periodic ? 0.01 * bed.width : bed.width * uniform(random);
            g.position[1][i] += 0.1 * bed.d * (uniform(random) - 0.5);
          }
        EXPECT_TRUE(map.cut(g, rule));
        expect_same(map, cut_at_once(channel.space, g, rule));
      }

    // less than the tolerance is not seen, its sum is
    auto tolerant      = rule;
    tolerant.tolerance = 1e-3;
    g.position[0][3] += 0.8e-3 * 2. * g.radius[3];
    EXPECT_FALSE(map.cut(g, tolerant));
    g.position[0][3] += 0.8e-3 * 2. * g.radius[3];
    EXPECT_TRUE(map.cut(g, tolerant));
    expect_same(map, cut_at_once(channel.space, g, rule));

    // other discs are other pieces
    auto              other = tolerant;
    const std::size_t n     = map.grain().size();
    other.filter_radius     = 3.;
    EXPECT_TRUE(map.cut(g, other));
    EXPECT_GT(map.grain().size(), n);
    using Shape = coupling::OverlapSettings::Shape;
    other.shape = rule.shape == Shape::top_hat ? Shape::parabolic : Shape::top_hat;
    EXPECT_TRUE(map.cut(g, other));
    EXPECT_FALSE(map.cut(g, other));
  }

  TEST(OverlapMap, EvenGrainsAreEvenUpToTheSides)
  {
    // a square array with a node midway between any four grains
    Bed bed;
    bed.d = 2.2e-4;
    bed.grains.resize(64);
    for (std::size_t k = 0; k < 64; ++k)
      {
        bed.grains.id[k]          = k;
        bed.grains.position[0][k] = (0.5 + k % 8) * bed.d;
        bed.grains.position[1][k] = (0.5 + k / 8) * bed.d;
        bed.grains.radius[k] = bed.grains.fluid_radius[k] = 0.4 * bed.d;
      }
    for (const bool smooth : {false, true})
      {
        Settings settings;
        settings.smooth = smooth;
        Channel channel(8. * bed.d, 8. * bed.d, bed.d, settings, 0.);
        channel.coupling.update_void_fraction(bed.grains);
        for (const double eps : channel.coupling.void_fraction())
          EXPECT_NEAR(eps, 1. - 0.16 * M_PI, 1e-12);
      }
  }

  // Whatever the mesh, a grain's pieces add up to it, their first moments to its centre, and the solid in the void
  // fraction to all grains.
  /** @p n x @p n grains in a square array of mesh width @p d [m], turned by @p angle about the origin. */
  grains::GrainArrays square_array(const unsigned int n, const double d, const double angle)
  {
    grains::GrainArrays g;
    g.resize(n * n);
    for (unsigned int k = 0; k < n * n; ++k)
      {
        const double x = (0.5 + k % n) * d, y = (0.5 + k / n) * d;
        g.id[k]          = k;
        g.position[0][k] = std::cos(angle) * x - std::sin(angle) * y;
        g.position[1][k] = std::sin(angle) * x + std::cos(angle) * y;
        g.radius[k] = g.fluid_radius[k] = 0.4 * d;
      }
    return g;
  }

  /** Cells of side @p d in a square of @p n x @p n; no fluid gets through x = n / 2 d above y = @p tip d. */
  void make_cracked(Triangulation<2> &tria, const unsigned int n, const double d, const double tip)
  {
    Triangulation<2> whole;
    GridGenerator::subdivided_hyper_cube(whole, n, 0., n * d);
    auto                                 vertices = whole.get_vertices();
    std::map<unsigned int, unsigned int> twin;
    std::vector<CellData<2>>             cells;
    for (const auto &cell : whole.active_cell_iterators())
      {
        cells.emplace_back();
        for (const unsigned int v : cell->vertex_indices())
          {
            unsigned int index = cell->vertex_index(v);
            const auto   point = cell->vertex(v);
            if (cell->center()[0] > 0.5 * n * d && std::abs(point[0] - 0.5 * n * d) < 0.1 * d && point[1] > tip * d)
              {
                if (twin.count(index) == 0)
                  {
                    twin[index] = vertices.size();
                    vertices.push_back(point);
                  }
                index = twin[index];
              }
            cells.back().vertices[v] = index;
          }
      }
    tria.create_triangulation(vertices, cells, SubCellData());
  }

  struct SlipSpace
  {
    explicit SlipSpace(const Triangulation<2> &tria)
    {
      bc.set(0, {boundary_kinds::slip, "walls", nullptr});
      space.attach(tria);
      space.reinit(bc);
    }

    fluid::BoundaryConditions<2> bc;
    fluid::FluidSpace<2>         space;
  };

  coupling::OverlapSettings two_diameters()
  {
    coupling::OverlapSettings settings;
    settings.filter_radius = 2.;
    return settings;
  }

  TEST(OverlapMap, NothingOfAGrainGetsThroughAThinWall)
  {
    parallel::distributed::Triangulation<2> tria(MPI_COMM_WORLD);
    const double                            d = 2.2e-4;
    make_cracked(tria, 8, d, 2.5);
    const SlipSpace     fluid(tria);
    grains::GrainArrays grain = square_array(1, d, 0.);
    grain.position[0][0]      = 3.5 * d;
    grain.position[1][0]      = 6. * d;
    const auto map            = cut_at_once(fluid.space, grain, two_diameters());
    double     area           = 0.;
    const auto cells          = fluid.space.cells();
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int k = map.terms().begin[c]; k < map.terms().begin[c + 1]; ++k)
        {
          area += map.terms().shape[k].area;
          EXPECT_LT(cells[c].vertex[0][0], 3.5 * d);
        }
    EXPECT_NEAR(Utilities::MPI::sum(area, MPI_COMM_WORLD) / (M_PI * 0.16 * d * d), 1., 1e-12);
  }

  TEST(OverlapMap, EvenGrainsAreEvenUpToAThinWall)
  {
    parallel::distributed::Triangulation<2> tria(MPI_COMM_WORLD);
    const double                            d = 2.2e-4;
    for (const double tip : {-1., 3.5})
      {
        tria.clear();
        make_cracked(tria, 8, d, tip);
        const SlipSpace fluid(tria);
        const auto      map = cut_at_once(fluid.space, square_array(8, d, 0.), two_diameters());
        auto            eps = fluid.space.make_nodal_field();
        coupling::lumped_void_fraction(map.terms(), fluid.space, eps);
        // round the tip a cell's piece goes to one side as a whole
        for (const double e : eps)
          EXPECT_NEAR(e, 1. - 0.16 * M_PI, tip < 0. ? 1e-12 : 0.02);
      }
  }

  TEST(OverlapMap, EvenGrainsAreEvenUpToInclinedSides)
  {
    parallel::distributed::Triangulation<2> tria(MPI_COMM_WORLD);
    const double                            d = 2.2e-4, angle = 0.5;
    const unsigned int                      n = 14;
    GridGenerator::subdivided_hyper_cube(tria, n, 0., n * d);
    GridTools::rotate(angle, tria);
    const SlipSpace fluid(tria);
    const auto      map = cut_at_once(fluid.space, square_array(n, d, angle), two_diameters());
    auto            eps = fluid.space.make_nodal_field();
    coupling::lumped_void_fraction(map.terms(), fluid.space, eps);
    eps.update_ghost_values();
    unsigned int n_sides = 0;
    for (const auto &cell : fluid.space.cells())
      for (unsigned int v = 0; v < 4; ++v)
        {
          const double e = eps.local_element(cell.node[v]);
          const auto  &p = cell.vertex[v];
          const double x = std::cos(angle) * p[0] + std::sin(angle) * p[1],
                       y = std::cos(angle) * p[1] - std::sin(angle) * p[0];
          n_sides += std::min(x, y) < 0.1 * d || std::max(x, y) > (n - 0.1) * d;
          EXPECT_NEAR(e, 1. - 0.16 * M_PI, 1e-12) << x / d << " " << y / d;
        }
    EXPECT_GT(Utilities::MPI::sum(n_sides, MPI_COMM_WORLD), 0u);
  }

  TEST(OverlapMap, SmoothGrainsLoseNothing)
  {
    for (const std::string mesh : {"quadrilaterals", "hanging nodes", "triangles", "periodic"})
      for (const double h : {4., 1., 0.25})
        {
          Bed      bed = random_bed(1, 16., 12.);
          Settings settings;
          settings.smooth    = true;
          settings.h_over_d  = h;
          settings.graded    = mesh == "hanging nodes";
          settings.triangles = mesh == "triangles";
          settings.periodic  = mesh == "periodic";
          Channel channel(bed.width, bed.height, h * bed.d, settings, 0.);
          channel.coupling.settings.keep_arms = true;
          channel.coupling.update_void_fraction(bed.grains);
          const auto         &map = channel.coupling.overlap();
          const auto         &g   = bed.grains;
          std::vector<double> area(g.n(), 0.), x(g.n(), 0.), y(g.n(), 0.);
          for (std::size_t k = 0; k < map.grain().size(); ++k)
            {
              const double a = map.terms().shape[k].area;
              area[map.grain()[k]] += a;
              x[map.grain()[k]] += a * map.arms()[k].arm[0];
              y[map.grain()[k]] += a * map.arms()[k].arm[1];
            }
          double grains = 0., solid = 0.;
          for (std::size_t i = 0; i < g.n(); ++i)
            {
              const double exact = M_PI * g.fluid_radius[i] * g.fluid_radius[i];
              grains += exact;
              EXPECT_NEAR(area[i] / exact, 1., 1e-13);
              if (g.position[0][i] > 3. * bed.d && g.position[0][i] < bed.width - 3. * bed.d &&
                  g.position[1][i] > 3. * bed.d && g.position[1][i] < bed.height - 3. * bed.d) // images aside
                {
                  EXPECT_NEAR(x[i] / (exact * bed.d), 0., 1e-11);
                  EXPECT_NEAR(y[i] / (exact * bed.d), 0., 1e-11);
                }
            }
          const auto &volumes = channel.space.node_volumes();
          for (unsigned int i = 0; i < volumes.locally_owned_size(); ++i)
            {
              const double eps = channel.coupling.void_fraction().local_element(i);
              solid += volumes.local_element(i) * (1. - eps);
              EXPECT_GE(eps, 0.);
              EXPECT_LE(eps, 1.);
            }
          EXPECT_NEAR(solid / grains, 1., 1e-12) << mesh << ", h/d " << h;
        }
  }

  TEST(OverlapMap, KeepsThePiecesOfGrainsThatStand)
  {
    for (const bool periodic : {false, true})
      for (const bool arms : {false, true}) // with them cells are cut one by one
        for (const bool smooth : {false, true})
          {
            coupling::OverlapSettings rule;
            rule.keep_arms = arms;
            rule.shape =
              smooth ? coupling::OverlapSettings::Shape::parabolic : coupling::OverlapSettings::Shape::top_hat;
            keeps_what_stands(periodic, rule);
          }
  }

  // By lines or cell by cell: beside mirrors and periodic boundaries, and where nodes hang.
  TEST(OverlapMap, BothWaysOfCuttingAgree)
  {
    using Shape = coupling::OverlapSettings::Shape;
    for (const std::string mesh : {"uniform", "hanging nodes", "periodic"})
      for (const double h : {4., 1., 0.25})
        for (const Shape shape : {Shape::top_hat, Shape::parabolic})
          {
            const Bed bed = random_bed(1, 16., 12.);
            Settings  settings;
            settings.h_over_d = h;
            settings.graded   = mesh == "hanging nodes";
            settings.periodic = mesh == "periodic";
            Channel channel(bed.width, bed.height, h * bed.d, settings, 0.);
            auto    rule          = channel.coupling.settings;
            rule.shape            = shape;
            const auto by_lines   = cut_at_once(channel.space, bed.grains, rule);
            rule.keep_arms        = true;
            const auto by_cells   = cut_at_once(channel.space, bed.grains, rule);
            const auto moments_of = [&](const coupling::OverlapMap &map, const unsigned int cell) {
              std::map<unsigned int, std::array<double, 5>> sums; // by grain: area, and area times phi
              for (unsigned int k = map.terms().begin[cell]; k < map.terms().begin[cell + 1]; ++k)
                {
                  const auto &s = map.terms().shape[k];
                  const auto  g = map.grain()[k];
                  const auto  V = M_PI * bed.grains.fluid_radius[g] * bed.grains.fluid_radius[g];
                  sums[g][0] += s.area / V;
                  for (unsigned int v = 0; v < 4; ++v)
                    sums[g][v + 1] += s.area / V * s.phi[v];
                }
              return sums;
            };
            double worst = 0.;
            for (unsigned int c = 0; c < channel.space.cells().size(); ++c)
              {
                auto a = moments_of(by_lines, c), b = moments_of(by_cells, c);
                for (const auto &[g, sums] : a)
                  b[g]; // slivers may be in one and not in the other
                for (const auto &[g, sums] : b)
                  for (unsigned int i = 0; i < 5; ++i)
                    worst = std::max(worst, std::abs(sums[i] - a[g][i]));
              }
            EXPECT_GT(by_lines.terms().n_pieces(), bed.grains.n());
            EXPECT_LT(worst, 1e-12) << mesh << ", h/d " << h;
          }
  }

  // for comparison: all of a grain in the cell of its centre, shared where the centre is on a face
  TEST(OverlapMap, CentreRule)
  {
    Bed      bed = random_bed(1, 20., 10.);
    Settings settings;
    settings.h_over_d = 4.;
    Channel              channel(bed.width, bed.height, 4. * bed.d, settings, 0.);
    coupling::OverlapMap map(channel.space);
    map.reinit();
    const auto &first         = channel.space.cells()[0].vertex;
    bed.grains.position[0][0] = first[1][0]; // between two cells
    bed.grains.position[1][0] = 0.5 * (first[0][1] + first[2][1]);
    auto rule                 = channel.coupling.settings;
    rule.rule                 = coupling::OverlapSettings::Rule::particle_centre;
    map.cut(bed.grains, rule);
    EXPECT_EQ(map.terms().n_pieces(), bed.grains.n() + 1);
    std::vector<double> area(bed.grains.n(), 0.);
    for (std::size_t k = 0; k < map.terms().n_pieces(); ++k)
      {
        area[map.grain()[k]] += map.terms().shape[k].area;
        for (const double phi : map.terms().shape[k].phi)
          EXPECT_NEAR(phi, 0.25, 1e-12);
      }
    for (std::size_t g = 0; g < bed.grains.n(); ++g)
      EXPECT_NEAR(area[g] / (numbers::PI * std::pow(bed.grains.fluid_radius[g], 2)), 1., 1e-13);
  }
} // namespace
