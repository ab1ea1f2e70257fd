// A given velocity is a flux: what enters is its integral over the boundary, whatever the mesh, its nodes, the void
// fraction and the walls beside it; parts of sides have conditions of their own.
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

namespace
{
  using namespace dealii;
  using namespace alluvium;
  using namespace alluvium::fluid;
  constexpr int    dim    = 2;
  constexpr double height = 0.02, width = 0.03; // [m]

  const std::map<std::string, unsigned int> sides = {{"left", 0}, {"right", 1}, {"bottom", 2}, {"top", 3}};

  struct Tank
  {
    /** @p n cells along x; @p parts have ids from 4 on. */
    Tank(const unsigned int                                      n,
         const bool                                              triangles,
         const std::vector<std::pair<std::string, std::string>> &parameters,
         const std::vector<geometry::BoundaryPart>              &parts         = {},
         const std::function<double(const Point<dim> &)>        &void_fraction = {})
    {
      const std::vector<unsigned int> cells = {n, std::max(1u, 2 * n / 3)};
      if (triangles)
        {
          Triangulation<dim> quadrilaterals;
          GridGenerator::subdivided_hyper_rectangle(
            quadrilaterals, cells, Point<dim>(), Point<dim>(width, height), true);
          GridGenerator::convert_hypercube_to_simplex_mesh(quadrilaterals, mesh);
        }
      else
        GridGenerator::subdivided_hyper_rectangle(mesh, cells, Point<dim>(), Point<dim>(width, height), true);
      ParameterHandler prm;
      conditions.add_parameters(prm);
      prm.enter_subsection("Boundary conditions");
      for (const auto &[name, value] : parameters)
        prm.set(name, value);
      auto ids = sides;
      for (const auto &part : parts)
        ids[part.name] = part.id;
      conditions.initialize(ids, {});
      space.attach(mesh);
      space.boundary().set_parts(parts);
      space.reinit(conditions);
      solver                          = std::make_unique<VansSolver<dim>>(space);
      solver->properties              = {1000., 1e-3};
      solver->linear_solver.tolerance = 1e-13;
      solver->reinit();
      eps = space.make_nodal_field();
      for (const auto &cell : space.cells())
        for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
          eps.local_element(cell.node[v]) = void_fraction ? void_fraction(cell.vertex[v]) : 1.;
      problem.void_fraction = &eps;
      problem.solid         = &no_solid;
      problem.dt            = 1e-3;
    }

    void step(const unsigned int n = 3)
    {
      for (unsigned int i = 0; i < n; ++i)
        {
          conditions.set_time((time += problem.dt));
          solver->accept();
          solver->begin_step(conditions, problem);
          solver->solve();
        }
    }

    /** Integral of eps u over the boundary [m^2/s]: what the field itself carries through y = 0. */
    double field_flux() const
    {
      double sum = 0.;
      for (const auto &cell : space.cells())
        {
          std::vector<std::array<double, 3>> ends; // x, eps, u
          for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
            if (cell.vertex[v][1] == 0.)
              ends.push_back({{cell.vertex[v][0],
                               eps.local_element(cell.node[v]),
                               solver->solution().block(0).local_element(cell.velocity[v][1])}});
          if (ends.size() == 2)
            sum += std::abs(ends[1][0] - ends[0][0]) / 6. *
                   (2. * ends[0][1] * ends[0][2] + ends[0][1] * ends[1][2] + ends[1][1] * ends[0][2] +
                    2. * ends[1][1] * ends[1][2]);
        }
      return sum;
    }

    Triangulation<dim>               mesh;
    BoundaryConditions<dim>          conditions;
    FluidSpace<dim>                  space;
    std::unique_ptr<VansSolver<dim>> solver;
    alluvium::fluid::Vector          eps;
    InterphaseTerms<dim>             no_solid;
    VansProblem<dim>                 problem{};
    double                           time = 0.;
  };

  const geometry::BoundaryPart inlet{"inlet", "bottom", 4, 2, 0, 0.014, 0.016};

  /** What comes out at the top must be @p flux, and so what is said to go in. */
  void expect_flux(Tank &tank, const unsigned int in, const double flux, const std::string &where)
  {
    EXPECT_NEAR(-tank.solver->flux(in), flux, 1e-10 * flux) << where;
    EXPECT_NEAR(tank.solver->flux(3), flux, 1e-10 * flux) << where;
  }
} // namespace


TEST(GivenVelocity, SeveralSlotsInACellAndNarrowOnes)
{
  for (const auto &[formula, flux] :
       std::map<std::string, double>{{"if(x>0.0101 && x<0.0105, 0.1, 0) + if(x>0.0112 && x<0.0114, 0.1, 0)", 6e-5},
                                     {"if(abs(x-0.0153)<2e-5, 0.1, 0)", 4e-6},
                                     {"if(abs(x-0.01234)<1e-5, 1, 0)", 2e-5},
                                     {"if(x<0.0111, 0.1, if(x<0.0112, 0, 0.1))", 0.1 * (width - 1e-4)}})
    for (const unsigned int n : {12, 31})
      {
        Tank tank(
          n, false, {{"Slip walls", "left, right"}, {"Velocity", "bottom: 0 | " + formula}, {"Pressure", "top: 0"}});
        tank.step();
        expect_flux(tank, 2, flux, formula + " on " + std::to_string(n));
      }
}

TEST(GivenVelocity, SlotNarrowerThanACell)
{
  for (const bool triangles : {false, true})
    for (const unsigned int n : {7, 8, 15, 30, 60})
      {
        const std::string where = std::to_string(n) + (triangles ? " triangles" : " squares");
        Tank              formula(n,
                     triangles,
                     {{"Slip walls", "left, right"},
                                   {"Velocity", "bottom: 0 | if(abs(x-0.015)<0.001, 0.25, 0)"},
                                   {"Pressure", "top: 0"}});
        formula.step();
        expect_flux(formula, 2, 5e-4, where);
        EXPECT_NEAR(formula.field_flux(), 5e-4, 1e-3 * 5e-4) << where;
        for (const char *walls : {"No-slip walls", "Slip walls"})
          {
            Tank part(n,
                      triangles,
                      {{walls, "left, right, bottom"}, {"Velocity", "inlet: 0 | 0.25"}, {"Pressure", "top: 0"}},
                      {inlet});
            part.step();
            expect_flux(part, 4, 5e-4, where);
            EXPECT_NEAR(part.field_flux(), 5e-4, 1e-10) << where;
          }
      }
}


// No-slip corners, and a void fraction that changes along the inlet.
TEST(GivenVelocity, WhateverWallsAndVoidFraction)
{
  for (const unsigned int n : {1, 2, 9, 30})
    for (const char *walls : {"No-slip walls", "Slip walls"})
      {
        Tank tank(n,
                  false,
                  {{walls, "left, right"}, {"Velocity", "bottom: 0 | 0.01"}, {"Pressure", "top: 0"}},
                  {},
                  [](const Point<dim> &x) { return 0.4 + 0.3 * std::sin(500. * x[0]) * std::exp(-x[1] / 0.005); });
        tank.step();
        expect_flux(tank, 2, 0.01 * width, std::to_string(n));
      }
}


TEST(GivenVelocity, Interstitial)
{
  Tank tank(15,
            false,
            {{"Slip walls", "left, right"},
             {"Velocity", "bottom: 0 | 0.01"},
             {"Given velocity", "interstitial"},
             {"Pressure", "top: 0"}},
            {},
            [](const Point<dim> &) { return 0.4; });
  tank.step();
  expect_flux(tank, 2, 0.4 * 0.01 * width, "interstitial");
  EXPECT_NEAR(tank.field_flux(), 0.4 * 0.01 * width, 1e-12);
}


// Inlet and outlet in the same side, and an outlet that meets another one.
TEST(GivenVelocity, PartsBesideEachOther)
{
  const std::vector<geometry::BoundaryPart> parts = {{"in", "bottom", 4, 2, 0, 0.0113, 0.0171},
                                                     {"out", "bottom", 5, 2, 0, 0.0171, 0.0304},
                                                     {"corner", "right", 6, 1, 1, 0.013, 1.}};
  for (const unsigned int n : {15, 40})
    {
      Tank tank(n,
                false,
                {{"No-slip walls", "left, bottom, right"},
                 {"Velocity", "in: 0 | 0.02 + x"},
                 {"Pressure", "out: 0; corner: 0; top: 0"}},
                parts);
      tank.step();
      const double in  = 0.02 * 0.0058 + 0.5 * (0.0171 * 0.0171 - 0.0113 * 0.0113);
      const double out = tank.solver->flux(5) + tank.solver->flux(6) + tank.solver->flux(3);
      EXPECT_NEAR(-tank.solver->flux(4), in, 1e-12 * in);
      EXPECT_NEAR(out, in, 1e-10 * in);
      EXPECT_GT(tank.solver->flux(5), 0.);
    }
}


TEST(GivenVelocity, NoNodeForAPressure)
{
  try
    {
      Tank tank(8,
                false,
                {{"Slip walls", "left, right, bottom"}, {"Velocity", "top: 0 | -0.1"}, {"Pressure", "inlet: 0"}},
                {{"inlet", "bottom", 4, 2, 0, 0.016, 0.018}});
      FAIL();
    }
  catch (const UserError &error)
    {
      EXPECT_NE(std::string(error.what()).find("no node of the fluid's mesh lies on 'inlet'"), std::string::npos)
        << error.what();
    }
}


TEST(GivenVelocity, FacesAreDivided)
{
  const auto whole = geometry::divide_face({inlet}, 3, {{0., 0.}}, {{1., 0.}});
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_TRUE(whole[0].is_whole());
  const auto three = geometry::divide_face({inlet}, 2, {{0.02, 0.}}, {{0.01, 0.}});
  ASSERT_EQ(three.size(), 3u);
  EXPECT_EQ(three[0].id, 2u);
  EXPECT_EQ(three[1].id, 4u);
  EXPECT_NEAR(three[1].begin, 0.4, 1e-12);
  EXPECT_NEAR(three[1].end, 0.6, 1e-12);
  EXPECT_TRUE(three[2].has_second());
}


TEST(GivenVelocity, FormulasThatMayJump)
{
  using Conditions    = BoundaryConditions<dim>;
  const auto may_jump = [](const std::string &text) {
    return Conditions::Condition{nullptr, "left", nullptr, text}.may_jump();
  };
  for (const char *text :
       {"if(x < 1, 1, 0) | 0", "max(0, x) | 0", "0 | rint(x)", "(x > 1)*2 | 0", "rand_seed(1) | 0", ""})
    EXPECT_TRUE(may_jump(text)) << text;
  // words that only begin or end so are names of constants
  for (const char *text : {"0.1*y*(1 - y) | 0", "u_max*y | 0", "minute*x | 0", "gif | x_int"})
    EXPECT_FALSE(may_jump(text)) << text;
}


TEST(Expression, SeveralValues)
{
  const auto error = [](const std::string &text) -> std::string {
    try
      {
        parse_expressions("here", {text}, {{"H", 2.}});
      }
    catch (const UserError &e)
      {
        return e.what();
      }
    return "";
  };
  for (const char *text : {"0,5", "H + 0,5*x", "(1,5)*x", "1, 2", "max(1, 2), 3"})
    EXPECT_NE(error(text).find("several values"), std::string::npos) << text;
  EXPECT_NE(error("sin(0,5)").find("a point, not a comma"), std::string::npos);
  for (const char *text : {"max(1, 2)", "if(x < 1, max(2, x), 3)", "H*(1+t)", "max((1+x)*2, 3)"})
    EXPECT_EQ(error(text), "") << text;
  for (const char *text : {"x=1", "if(x = 1, 2, 3)", "= 1"})
    EXPECT_NE(error(text).find("write '=='"), std::string::npos) << text;
  for (const char *text : {"if(x == 1, 2, 3)", "(x <= 1) + (x >= 2) + (x != 3)"})
    EXPECT_EQ(error(text), "") << text;
  EXPECT_TRUE(mentions("sin(2*pi*t)", "t"));
  EXPECT_FALSE(mentions("sqrt(x) + rho_t", "t"));
}


TEST(Expression, OnlyOurMessageIsPrinted)
{
  for (const char *text : {"-", "", "1 +", "foo", "sin()"})
    {
      testing::internal::CaptureStderr();
      EXPECT_THROW(parse_expressions("here", {text}, {}), UserError) << text;
      std::cerr << "still here";
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "still here") << text;
    }
}
