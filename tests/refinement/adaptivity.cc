#include "fixtures/test_mesh.h"
#include "fixtures/test_space.h"

#include <alluvium/refinement/adaptivity.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <cmath>

namespace
{
  using namespace dealii;
  using namespace alluvium;
  using alluvium::fluid::FieldTransfer;
  using namespace alluvium::mesh;
  using namespace alluvium::refinement;
  using namespace mesh_test;

  using Parameters = std::vector<std::pair<std::string, std::string>>;

  /** A bed of grains of diameter @p d in rows, from y = @p bottom to @p top, in 0 <= x <= 1. */
  grains::GrainArrays make_bed(const double d, const double bottom, const double top)
  {
    grains::GrainArrays result;
    for (double y = bottom + d / 2.; y < top; y += d)
      for (double x = d / 2.; x < 1.; x += d)
        {
          result.position[0].push_back(x);
          result.position[1].push_back(y);
        }
    const auto n = result.position[0].size();
    result.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      {
        result.id[i]     = i;
        result.radius[i] = d / 2.;
      }
    return result;
  }

  const Box unit_square{{{0., 0.}}, {{1., 1.}}};

  RefinementContext context_of(const grains::GrainArrays &grains)
  {
    return make_refinement_context(grains, unit_square);
  }

  double size(const Triangulation<2>::active_cell_iterator &cell)
  {
    return cell->diameter() / std::sqrt(2.);
  }

  /** The unit square with a mesh for @p context. */
  struct Scene
  {
    Scene(const Parameters &parameters, const RefinementContext &context)
    {
      set_parameters(adaptivity, prm, parameters);
      domain.initialize(MPI_COMM_WORLD, "");
      mesh   = domain.make_triangulation(adaptivity.coarse_size(context));
      report = adaptivity.make_initial_mesh(*mesh, context);
    }

    ParameterHandler                  prm;
    Domain<2>                         domain;
    Adaptivity<2>                     adaptivity;
    std::unique_ptr<Triangulation<2>> mesh;
    AdaptationReport                  report;
  };

  const double d = 1. / 64.;

  TEST(BedFaces, AreThoseOfTheBedAndNotOfStrayGrains)
  {
    auto       grains = make_bed(d, 0.25, 0.5);
    const auto clean  = find_bed_faces(grains, 0., 1.);
    ASSERT_EQ(clean.columns.size(), 8u);
    EXPECT_NEAR(clean.top(), 0.5, 1e-12);
    EXPECT_NEAR(clean.bottom(), 0.25, 1e-12);
    EXPECT_NEAR(mean_diameter(grains), d, 1e-12);

    // two grains fly above one column and one lies below another
    const auto n = grains.n();
    grains.resize(n + 3);
    grains.position[0][n] = 0.03, grains.position[1][n] = 0.9, grains.radius[n] = d / 2.;
    grains.position[0][n + 1] = 0.05, grains.position[1][n + 1] = 0.8, grains.radius[n + 1] = d / 2.;
    grains.position[0][n + 2] = 0.7, grains.position[1][n + 2] = 0.1, grains.radius[n + 2] = d / 2.;
    const auto disturbed = find_bed_faces(grains, 0., 1.);
    EXPECT_NEAR(disturbed.top(), 0.5, 1e-12);
    EXPECT_NEAR(disturbed.bottom(), 0.25, 1e-12);

    EXPECT_TRUE(find_bed_faces(grains::GrainArrays(), 0., 1.).empty());
  }

  TEST(BedFaces, AreNotThoseOfARain)
  {
    // as much as a quarter of a layer in each column, but scattered over its height: alone, above a bed and below it
    for (const double bed : {0., 0.25})
      {
        auto              grains = bed > 0. ? make_bed(d, 0.4, 0.4 + bed) : grains::GrainArrays();
        const std::size_t n = grains.n(), n_rain = 64;
        grains.resize(n + n_rain);
        for (std::size_t k = 0; k < n_rain; ++k)
          {
            const double side         = k % 2 == 0 ? 0.02 : 0.7;
            grains.position[0][n + k] = (k % 8 + 0.5) / 8.;
            grains.position[1][n + k] = side + 0.3 * (k / 8) / 8.;
            grains.radius[n + k]      = d / 2.;
          }
        const auto faces = find_bed_faces(grains, 0., 1.);
        ASSERT_EQ(faces.empty(), bed == 0.);
        if (bed == 0.)
          continue;
        EXPECT_NEAR(faces.bottom(), 0.4, 1e-12);
        EXPECT_NEAR(faces.top(), 0.4 + bed, 1e-12);
      }
    // two large grains that fall one above the other
    grains::GrainArrays grains;
    grains.resize(2);
    grains.position[0] = {2.5 * d, 2.6 * d};
    grains.position[1] = {5. * d, 40. * d};
    grains.radius.assign(2, d / 2.);
    EXPECT_TRUE(find_bed_faces(grains, 0., 5.4 * d).empty());
  }

  TEST(BedFaces, DoNotHangOnRoundOff)
  {
    // a box one and a half columns wide: two, also shifted and in other units
    const auto height = [](const double factor, const double shift) {
      grains::GrainArrays grains;
      grains.position[0] = {2. * factor + shift, 6. * factor + shift, 9. * factor + shift};
      grains.position[1] = {0., 2. * std::abs(factor), 6. * std::abs(factor)};
      grains.resize(3);
      grains.radius.assign(3, 2.2 * std::abs(factor));
      const double left = shift + std::min(0., 12. * 4.4 * factor), right = shift + std::max(0., 12. * 4.4 * factor);
      return find_bed_faces(grains, left, right).columns.size() * 100. +
             find_bed_faces(grains, left, right).mean_height() / std::abs(factor);
    };
    for (const double factor : {0.1, 0.3, 0.7, 1.3, 1e-3, 1. / 7.})
      for (const double shift : {0., 0.1, 1. / 3., 12345.678})
        EXPECT_NEAR(height(factor, shift), height(1., 0.), 1e-6) << factor << ' ' << shift;
    const auto between = [](const double offset) {
      auto grains = make_bed(d, 0., 0.5);
      for (double &x : grains.position[0])
        x += d / 2. + offset; // those of every eighth line of grains stand between columns
      return find_bed_faces(grains, 0., 1.).mean_height();
    };
    EXPECT_NEAR(between(1e-12), between(-1e-12), 1e-9);
  }

  TEST(BedFaces, FollowAStep)
  {
    auto grains = make_bed(d, 0., 0.5);
    for (std::size_t i = 0; i < grains.n(); ++i)
      if (grains.position[0][i] > 0.5)
        grains.position[1][i] *= 0.5;
    const auto faces = find_bed_faces(grains, 0., 1.);
    EXPECT_NEAR(faces.distance_to_top({{0.1, 0.5}}, {{0.2, 0.6}}), 0., 1e-12);
    EXPECT_NEAR(faces.distance_to_top({{0.8, 0.55}}, {{0.9, 0.6}}), 0.3, 1.5 * d);
    EXPECT_NEAR(faces.distance_to_bottom({{0.8, 0.5}}, {{0.9, 0.6}}), 0.5, 1.5 * d);
  }

  TEST(Adaptivity, KnowsWhenAMeshIsNeverRefined)
  {
    const auto grains        = make_bed(d, 0., 0.5);
    const auto context       = context_of(grains);
    const auto never_refines = [&](const Parameters &parameters, const double size) {
      ParameterHandler prm;
      Adaptivity<2>    adaptivity;
      set_parameters(adaptivity, prm, parameters);
      return adaptivity.never_refines(size * d, context);
    };
    const Parameters uniform = {{"Mesh refinement/Criteria", "uniform"},
                                {"Mesh refinement/Criteria: uniform/Cell size", "2"},
                                {"Mesh refinement/Interval", "0"}};
    EXPECT_TRUE(never_refines(uniform, 2.));
    EXPECT_TRUE(never_refines(uniform, 1.));
    EXPECT_FALSE(never_refines(uniform, 2.1)); // refined at the start
    Parameters other = uniform;
    other[2].second  = "5"; // the grains' mean diameter stays, but a criterion is asked again
    EXPECT_FALSE(never_refines(other, 2.));
    other           = uniform;
    other[0].second = "uniform, bed faces";
    EXPECT_FALSE(never_refines(other, 2.));
  }

  TEST(Adaptivity, UniformGivesExactlyTheWantedSize)
  {
    for (const double h : {0.5, 1., 4.})
      {
        const Scene scene(
          {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", std::to_string(h)}},
          context_of(make_bed(d, 0., 0.5)));
        EXPECT_NEAR(scene.report.smallest / d, h, 1e-6);
        EXPECT_NEAR(scene.report.largest / d, h, 1e-6);
        EXPECT_TRUE(scene.report.satisfied);
      }
  }

  TEST(Adaptivity, BedFacesAreFineAndTheRestGrowsCoarse)
  {
    const auto  context = context_of(make_bed(d, 0.25, 0.5));
    const Scene scene({{"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "1"},
                       {"Mesh refinement/Criteria: bed faces/Cell size at the top", "0.5"}},
                      context);
    EXPECT_TRUE(scene.report.satisfied);
    EXPECT_FALSE(scene.report.limited);
    EXPECT_NEAR(scene.report.smallest / d, 0.5, 1e-6);
    EXPECT_NEAR(scene.report.largest / d, 8., 1e-6);
    EXPECT_LT(scene.report.n_cells, 128u * 128u / 4u);
    for (const auto &cell : scene.mesh->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto box     = cell->bounding_box().get_boundary_points();
          const auto touches = [&](const double y) {
            return box.first[1] <= y + 2. * d && box.second[1] >= y - 2. * d;
          };
          if (touches(0.25))
            {
              EXPECT_LE(size(cell), d * (1. + 1e-6));
            }
          if (touches(0.5))
            {
              EXPECT_LE(size(cell), 0.5 * d * (1. + 1e-6));
            }
          for (const unsigned int f : cell->face_indices())
            if (!cell->face(f)->at_boundary() && cell->neighbor(f)->is_active())
              {
                EXPECT_LE(std::abs(cell->level() - cell->neighbor(f)->level()), 1);
              }
        }
  }

  TEST(Adaptivity, SmallestWishWinsAndLimitsHold)
  {
    const auto  context = context_of(make_bed(d, 0.25, 0.5));
    const Scene both(
      {{"Mesh refinement/Criteria", "bed faces, uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}},
      context);
    EXPECT_NEAR(both.report.smallest / d, 1., 1e-6);
    EXPECT_NEAR(both.report.largest / d, 2., 1e-6);

    const Scene limited({{"Mesh refinement/Finest cell size", "2"}, {"Mesh refinement/Coarsest cell size", "4"}},
                        context);
    EXPECT_NEAR(limited.report.smallest / d, 2., 1e-6);
    EXPECT_NEAR(limited.report.largest / d, 4., 1e-6);

    const Scene levels({{"Mesh refinement/Max levels", "1"}}, context);
    EXPECT_NEAR(levels.report.smallest / d, 4., 1e-6);
    EXPECT_TRUE(levels.report.limited);
    EXPECT_FALSE(levels.report.satisfied);
  }

  TEST(Adaptivity, SettlesAtOnceAndFollowsTheBed)
  {
    const auto context = context_of(make_bed(d, 0.25, 0.5));
    Scene      scene({}, context);
    for (unsigned int repeat = 0; repeat < 2; ++repeat)
      {
        const auto report = scene.adaptivity.adapt(*scene.mesh, context, {}, {});
        EXPECT_FALSE(report.changed);
      }
    // a bed that trembles by half a diameter to and fro changes the mesh at most once
    const auto shaken = context_of(make_bed(d, 0.25 + d / 2., 0.5 + d / 2.));
    scene.adaptivity.adapt(*scene.mesh, shaken, {}, {});
    EXPECT_FALSE(scene.adaptivity.adapt(*scene.mesh, context, {}, {}).changed);
    EXPECT_FALSE(scene.adaptivity.adapt(*scene.mesh, shaken, {}, {}).changed);
    // far away, the old bands are given up
    const auto moved  = context_of(make_bed(d, 0.5, 0.75));
    const auto report = scene.adaptivity.adapt(*scene.mesh, moved, {}, {});
    EXPECT_TRUE(report.changed);
    EXPECT_TRUE(report.satisfied);
    const Scene direct({}, moved);
    EXPECT_LT(report.n_cells, 1.3 * direct.report.n_cells);
    EXPECT_FALSE(scene.adaptivity.adapt(*scene.mesh, moved, {}, {}).changed);
  }

  /** The smallest and the largest cell that touches the disc of radius 3 d around (x, y). */
  std::array<double, 2> sizes_around(const Triangulation<2> &mesh, const double x, const double y)
  {
    std::array<double, 2> result{{1e300, 0.}};
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center().distance({x, y}) < 3. * d + 0.71 * size(cell))
        {
          result[0] = std::min(result[0], size(cell));
          result[1] = std::max(result[1], size(cell));
        }
    return {{Utilities::MPI::min(result[0], MPI_COMM_WORLD), Utilities::MPI::max(result[1], MPI_COMM_WORLD)}};
  }

  TEST(Adaptivity, FinenessFollowsTheGrainsThatMoveAndLetsThemGoLater)
  {
    const Parameters parameters = {{"Mesh refinement/Criteria", "moving grains"},
                                   {"Mesh refinement/Criteria: moving grains/Cell size", "0.5"},
                                   {"Mesh refinement/Criteria: moving grains/Speed", "0.1"}};
    auto             grains     = make_bed(d, 0.25, 0.5);
    auto             context    = context_of(grains);
    context.gravity             = 9.81;
    const double scale          = 0.1 * std::sqrt(9.81 * d);
    Scene        scene(parameters, context);
    EXPECT_NEAR(scene.report.smallest / d, 8., 1e-6); // nothing moves

    const auto boil = [&](const double x, const double speed) {
      for (std::size_t i = 0; i < grains.n(); ++i)
        grains.velocity[1][i] =
          std::hypot(grains.position[0][i] - x, grains.position[1][i] - 0.4) < 3. * d ? speed : 0.;
    };
    boil(0.25, 1.01 * scale);
    EXPECT_TRUE(scene.adaptivity.adapt(*scene.mesh, context, {}, {}).satisfied);
    EXPECT_NEAR(sizes_around(*scene.mesh, 0.25, 0.4)[1] / d, 0.5, 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.8, 0.4)[0] / d, 4. - 1e-6);

    // slower, but not slow enough to be let go: the mesh stays, to and fro
    boil(0.25, 0.8 * scale);
    EXPECT_FALSE(scene.adaptivity.adapt(*scene.mesh, context, {}, {}).changed);
    boil(0.25, 1.1 * scale);
    EXPECT_FALSE(scene.adaptivity.adapt(*scene.mesh, context, {}, {}).changed);

    // elsewhere: coarse behind
    boil(0.75, 2. * scale);
    scene.adaptivity.adapt(*scene.mesh, context, {}, {});
    EXPECT_NEAR(sizes_around(*scene.mesh, 0.75, 0.4)[1] / d, 0.5, 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.2, 0.4)[0] / d, 4. - 1e-6);
    boil(0.75, 0.);
    EXPECT_NEAR(scene.adaptivity.adapt(*scene.mesh, context, {}, {}).smallest / d, 8., 1e-6);
  }

  TEST(Adaptivity, AFormulaGivesTheSize)
  {
    const auto grains  = make_bed(d, 0.25, 0.5);
    auto       context = context_of(grains);
    Scene      scene({{"Mesh refinement/Criteria", "function"},
                      {"Mesh refinement/Criteria: function/Cell size", "if(abs(x - 0.25 - t) < 4*d, 1, 8)"}},
                context);
    EXPECT_NEAR(sizes_around(*scene.mesh, 0.25, 0.5)[1] / d, 1., 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.75, 0.5)[0] / d, 4. - 1e-6);
    context.time = 0.5;
    scene.adaptivity.adapt(*scene.mesh, context, {}, {});
    EXPECT_NEAR(sizes_around(*scene.mesh, 0.75, 0.5)[1] / d, 1., 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.25, 0.5)[0] / d, 4. - 1e-6);

    const auto bad = [&](const std::string &formula) {
      return error_of([&] {
        Scene({{"Mesh refinement/Criteria", "function"}, {"Mesh refinement/Criteria: function/Cell size", formula}},
              context);
      });
    };
    EXPECT_TRUE(contains(bad("3*w"), "Criteria: function/Cell size: cannot understand '3*w'"));
    EXPECT_TRUE(contains(bad("x - 0.5"), "sizes must be positive"));
  }

  /**
   * Fields given by functions on the unit square's mesh of side 1/16, half of that in its corner at (0, 0) if @p
   * fine_corner, and what a criterion makes of them.
   */
  struct FieldScene
  {
    FieldScene(const Parameters  &parameters,
               const std::string &flow,
               const std::string &void_fraction,
               const bool         fine_corner = false)
    {
      set_parameters(adaptivity, prm, parameters);
      domain.initialize(MPI_COMM_WORLD, "");
      mesh = domain.make_triangulation(1. / 8.);
      mesh->refine_global(1);
      if (fine_corner)
        {
          for (const auto &cell : mesh->active_cell_iterators())
            if (cell->is_locally_owned() && cell->center().norm() < 0.25)
              cell->set_refine_flag();
          mesh->execute_coarsening_and_refinement();
        }
      set_parameters(
        boundaries,
        boundary_prm,
        {{"Boundary conditions/Slip walls", "bottom, top, left, right"}, {"Boundary conditions/Pin pressure", "true"}});
      boundaries.initialize(domain.boundary_ids(), {});
      space.attach(*mesh);
      space.reinit(boundaries);
      space.reinit_field(solution);
      space.reinit_nodal_field(eps);
      FunctionParser<2> flow_parser(3), void_fraction_parser(1);
      flow_parser.initialize("x,y", flow, {});
      void_fraction_parser.initialize("x,y", void_fraction, {});
      VectorTools::interpolate(space.dof_handler(), flow_parser, solution);
      VectorTools::interpolate(space.nodal_dof_handler(), void_fraction_parser, eps);
      solution.update_ghost_values();
      eps.update_ghost_values();
      grains                   = make_bed(d, 0.25, 0.5);
      auto             context = context_of(grains);
      const FluidState state{space, solution, eps};
      context.fluid = &state;
      report        = adaptivity.adapt(*mesh, context, {}, {});
    }

    ParameterHandler                  prm, boundary_prm;
    Domain<2>                         domain;
    Adaptivity<2>                     adaptivity;
    std::unique_ptr<Triangulation<2>> mesh;
    fluid::BoundaryConditions<2>      boundaries;
    fluid::FluidSpace<2>              space;
    fluid::BlockVector                solution;
    fluid::Vector                     eps;
    grains::GrainArrays               grains;
    AdaptationReport                  report;
  };

  TEST(Adaptivity, FineWhereTheVoidFractionChanges)
  {
    // from 1 to 0.5 over 2 d = 1/32 about y = 0.5: 0.1 a cell takes cells of 0.4 d
    const FieldScene scene(
      {{"Mesh refinement/Criteria", "void fraction"}}, "0; 0; 0", "0.75 + 0.25*tanh(64*(y - 0.5))");
    EXPECT_LE(sizes_around(*scene.mesh, 0.3, 0.5)[1], 0.5 / 16.);
    EXPECT_GE(sizes_around(*scene.mesh, 0.3, 0.1)[0] / d, 4.);
    EXPECT_GE(sizes_around(*scene.mesh, 0.3, 0.9)[0] / d, 4.);
    // a change of less than that over a cell of any size is left alone
    const FieldScene flat({{"Mesh refinement/Criteria", "void fraction"}}, "0; 0; 0", "0.5 + 0.1*y");
    EXPECT_NEAR(flat.report.smallest / d, 8., 1e-6);
  }

  TEST(Adaptivity, FineWhereTheFlowWorksOnTheGrains)
  {
    // the power y^8 has the mean 1/9: high above y = (3/9)^(1/8) = 0.872
    const FieldScene scene({{"Mesh refinement/Criteria", "drag work"}}, "y^8; 0; -x", "0.5");
    EXPECT_NEAR(sizes_around(*scene.mesh, 0.5, 0.95)[1] / d, 1., 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.5, 0.4)[0] / d, 4.);
  }

  TEST(Adaptivity, FineWhereTheVelocitysGradientJumps)
  {
    const FieldScene scene({{"Mesh refinement/Criteria", "velocity jump"}}, "tanh(30*(y - 0.5)); 0; 0", "1");
    EXPECT_LE(sizes_around(*scene.mesh, 0.5, 0.5)[0] / d, 2. + 1e-6);
    EXPECT_GE(sizes_around(*scene.mesh, 0.5, 0.1)[0] / d, 4.);
    EXPECT_GE(sizes_around(*scene.mesh, 0.5, 0.9)[0] / d, 4.);
    // cells of several sizes: each error is that of its own cell
    const FieldScene mixed({{"Mesh refinement/Criteria", "velocity jump"}}, "tanh(30*(y - 0.5)); 0; 0", "1", true);
    for (const double x : {0.1, 0.5, 0.9})
      {
        EXPECT_LE(sizes_around(*mixed.mesh, x, 0.5)[0] / d, 2. + 1e-6);
        EXPECT_GE(sizes_around(*mixed.mesh, x, 0.9)[0] / d, 4.);
      }
    EXPECT_GE(sizes_around(*mixed.mesh, 0.5, 0.1)[0] / d, 4.);
    // the estimator sees no error in what the elements hold exactly
    const FieldScene linear({{"Mesh refinement/Criteria", "velocity jump"}}, "x + y; -y; 0", "1");
    EXPECT_NEAR(linear.report.smallest / d, 8., 1e-6);
  }

  TEST(Adaptivity, TooManyCellsAreRefusedAtTheStartAndAvoidedLater)
  {
    const auto context = context_of(make_bed(d, 0.25, 0.5));
    EXPECT_TRUE(contains(error_of([&] { Scene({{"Mesh refinement/Max cells", "500"}}, context); }), "Max cells"));

    // enough for the initial mesh, not for its doubling
    const Scene reference({}, context);
    const auto  n = std::to_string(reference.report.n_cells + 200);
    Scene       scene({{"Mesh refinement/Max cells", n}}, context);
    auto        tilted = make_bed(d, 0.25, 0.5);
    for (std::size_t i = 0; i < tilted.n(); ++i)
      tilted.position[1][i] += tilted.position[0][i] < 0.5 ? 0.3 : -0.2;
    const auto report = scene.adaptivity.adapt(*scene.mesh, context_of(tilted), {}, {});
    EXPECT_LE(report.n_cells, std::stoul(n));
  }

  TEST(Adaptivity, CellsAreCountedBeforeTheyAreMade)
  {
    const auto context = context_of(make_bed(d, 0.25, 0.5));
    const auto count   = [&](const Parameters &parameters) {
      ParameterHandler prm;
      Domain<2>        domain;
      Adaptivity<2>    adaptivity;
      set_parameters(adaptivity, prm, parameters);
      domain.initialize(MPI_COMM_WORLD, "");
      const auto mesh = domain.make_triangulation(adaptivity.coarse_size(context));
      const auto n    = domain.n_cells_of_rectangle(adaptivity.coarse_size(context));
      EXPECT_EQ(n[0] * n[1], mesh->n_global_active_cells());
      std::vector<CellCorners<2>> cells;
      for (const auto &cell : mesh->active_cell_iterators())
        if (cell->is_locally_owned())
          cells.push_back({{cell->vertex(0), cell->vertex(1), cell->vertex(2), cell->vertex(3)}});
      const double mine = adaptivity.expected_cells(cells, 1., context);
      return Utilities::MPI::sum(mine, mesh->get_communicator());
    };
    const Parameters uniform = {{"Mesh refinement/Criteria", "uniform, bed faces"},
                                {"Mesh refinement/Criteria: uniform/Cell size", "0.5"}};
    EXPECT_NEAR(count(uniform) / Scene(uniform, context).report.n_cells, 1., 1e-12); // weights are quotients
    // neighbours that differ by one level only add some; from here on not all cells are looked at
    for (const char *size : {"1", "0.25"})
      {
        const Parameters faces = {{"Mesh refinement/Criteria: bed faces/Cell size at the top", size},
                                  {"Mesh refinement/Criteria: bed faces/Half width", "4"}};
        const double     n     = Scene(faces, context).report.n_cells;
        EXPECT_NEAR(count(faces) / n, 1., 0.05) << size;
      }
    const Parameters function = {{"Mesh refinement/Criteria", "function"},
                                 {"Mesh refinement/Criteria: function/Cell size", "if(x < 0.3, 0.25, 4)"}};
    EXPECT_NEAR(count(function) / Scene(function, context).report.n_cells, 1., 0.05);

    // more than could ever be made
    const Parameters hopeless = {{"Mesh refinement/Criteria", "function"},
                                 {"Mesh refinement/Finest cell size", "0.001"},
                                 {"Mesh refinement/Max levels", "25"},
                                 {"Mesh refinement/Criteria: function/Cell size", "if(x < 1e-9, 4, 0.001)"}};
    EXPECT_NEAR(count(hopeless) / std::pow(64e3, 2), 1.05, 0.05); // halves of halves: 2^16 along a side
    EXPECT_TRUE(contains(error_of([&] { Scene(hopeless, context); }), "ask for about 4.3e+09 cells"));
  }

  TEST(Adaptivity, TrianglesStayAsTheyAre)
  {
    ParameterHandler prm, other_prm;
    Domain<2>        domain;
    set_parameters(domain, prm, {{"Domain/Mesh file", "triangles_41.msh"}});
    domain.initialize(MPI_COMM_WORLD, std::string(ALLUVIUM_TEST_DATA));
    const auto    mesh    = domain.make_triangulation(0.);
    const auto    context = context_of(make_bed(d, 0.25, 0.5));
    Adaptivity<2> asked, quiet;
    set_parameters(asked, prm, {});
    EXPECT_TRUE(contains(error_of([&] { asked.make_initial_mesh(*mesh, context); }), "Interval = 0"));
    set_parameters(quiet, other_prm, {{"Mesh refinement/Interval", "0"}});
    const auto report = quiet.make_initial_mesh(*mesh, context);
    EXPECT_FALSE(report.changed);
    EXPECT_FALSE(report.satisfied);
    EXPECT_FALSE(quiet.due(50));
    EXPECT_TRUE(asked.due(50));
    EXPECT_FALSE(asked.due(0));
    EXPECT_FALSE(asked.due(51));
  }

  TEST(Adaptivity, FewerCellsThanRanksIsAnError)
  {
    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    Domain<2>          domain;
    domain.initialize(MPI_COMM_WORLD, "");
    const auto mesh = domain.make_triangulation(1.);
    if (n_ranks == 1)
      Domain<2>::check_partition(*mesh);
    else
      EXPECT_TRUE(contains(error_of([&] { Domain<2>::check_partition(*mesh); }), "has 1 cells, too few for"));
  }

  TEST(FieldTransfer, LinearFieldsSurviveRefinementAndCoarseningExactly)
  {
    const auto context = context_of(make_bed(d, 0.25, 0.5));
    Scene      scene({}, context);
    Space      space(*scene.mesh);

    fluid::BlockVector field = space.field(), second = space.field();
    fluid::Vector      nodal = space.nodal_field();
    VectorTools::interpolate(space.dofs, LinearField(3), field);
    VectorTools::interpolate(space.nodal_dofs, LinearField(1), nodal);
    second = field;
    second *= 2.;
    for (auto *f : {&field, &second})
      f->update_ghost_values();
    nodal.update_ghost_values();

    FieldTransfer<2> transfer(space.dofs, space.nodal_dofs);
    unsigned int     n_before = 0, n_after = 0;
    const auto       moved  = context_of(make_bed(d, 0.4, 0.7));
    const auto       report = scene.adaptivity.adapt(
      *scene.mesh,
      moved,
      [&] {
        transfer.prepare({&field, &second}, {&nodal});
        ++n_before;
      },
      [&] {
        space.rebuild();
        field = second = space.field();
        nodal          = space.nodal_field();
        transfer.interpolate({&field, &second}, space.hanging, {&nodal}, space.nodal_hanging);
        ++n_after;
      });
    EXPECT_TRUE(report.changed);
    EXPECT_EQ(n_before, report.n_rounds);
    EXPECT_EQ(n_after, report.n_rounds);

    fluid::BlockVector exact       = space.field();
    fluid::Vector      exact_nodal = space.nodal_field();
    VectorTools::interpolate(space.dofs, LinearField(3), exact);
    VectorTools::interpolate(space.nodal_dofs, LinearField(1), exact_nodal);
    exact -= field;
    exact_nodal -= nodal;
    EXPECT_LT(exact.linfty_norm(), 1e-13);
    EXPECT_LT(exact_nodal.linfty_norm(), 1e-13);
    second.add(-2., field);
    EXPECT_LT(second.linfty_norm(), 1e-13);
    EXPECT_TRUE(field.has_ghost_elements());
  }
} // namespace
