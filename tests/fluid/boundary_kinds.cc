// Kinds of boundary conditions that have terms: walls with a slip length against the closed forms of plane flows, and
// one that the program does not know, through which fluid passes.
#include "channel.h"
#include "fixtures/leaky_wall.h"

#include <alluvium/utilities/user_error.h>

namespace
{
  using namespace fluid_channel;
  using alluvium::fluid::boundary_kind;

  const auto navier_slip = boundary_kind<2>("Navier slip");

  class BoundaryKinds : public testing::TestWithParam<Mesh>
  {
  };
} // namespace


// Between a wall with a slip length and a moving lid the velocity is linear, and vanishes that far behind the wall.
TEST_P(BoundaryKinds, CouetteWithSlipLength)
{
  const double lid = 0.05;
  for (const double slip_length : {1e-5, 1e-3, 0.1})
    {
      Channel c(GetParam(), 0.5e-3);
      c.set(0, navier_slip, std::to_string(slip_length));
      c.set(1, boundary_kinds::velocity, "0; 0.05");
      c.set(2, boundary_kinds::pressure, "0");
      c.set(3, boundary_kinds::pressure, "0");
      c.start();
      for (unsigned int n = 0; n < 15; ++n)
        c.step(5.);
      EXPECT_LT(c.largest(0), 1e-6 * lid) << slip_length;
      EXPECT_LT(c.error(1, [&](const Point<dim> &x) { return lid * (x[0] + slip_length) / (width + slip_length); }),
                1e-6 * lid)
        << slip_length;
    }
}


// Plane Poiseuille flow is faster by the slip velocity, slip length times the wall's shear rate. What the pressures
// give is taken by viscosity and, as the terms of boundaries, by friction at the walls.
TEST(BoundaryKind, PoiseuilleWithSlipLength)
{
  const double gradient = 1. / length; // 1 Pa over the length
  for (const double slip_length : {1e-4, 1e-3})
    {
      Channel c(Mesh::quadrilaterals, 0.2e-3);
      for (const unsigned int side : {0, 1})
        c.set(side, navier_slip, std::to_string(slip_length));
      c.set(2, boundary_kinds::pressure, "1");
      c.set(3, boundary_kinds::pressure, "0");
      c.start();
      for (unsigned int n = 0; n < 25; ++n)
        c.step(5.);
      const auto exact = [&](const Point<dim> &x) {
        return gradient / (2. * eta) * (x[0] * (width - x[0]) + slip_length * width);
      };
      const double fastest = exact(Point<dim>(0.5 * width, 0.));
      EXPECT_LT(c.largest(0), 1e-6 * fastest) << slip_length;
      EXPECT_LT(c.error(1, exact), 1e-5 * fastest) << slip_length;
      // (u_t eta/slip_length) u_t on both walls
      const double at_wall = exact(Point<dim>()), friction = 2. * length * eta / slip_length * at_wall * at_wall;
      EXPECT_NEAR(c.balance().open, friction, 1e-3 * friction) << slip_length;
    }
}


// Fluid passes a wall with pores as its values say, and what passes is what enters elsewhere, to the solver's
// tolerance, also where both meet at a corner. The wall alone says how high the pressure is.
TEST_P(BoundaryKinds, LeakyWall)
{
  const double k = 1e-3, outside = 3.;
  for (const bool beside : {false, true})
    {
      Channel c(GetParam(), 0.5e-3);
      c.set(0,
            beside ? boundary_kinds::Kind(boundary_kind<2>("Leaky walls")) : boundary_kinds::slip,
            beside ? "0.001; 3" : "");
      c.set(1, boundary_kinds::slip);
      c.set(2, boundary_kinds::pressure, "13");
      c.set(3,
            beside ? boundary_kinds::slip : boundary_kinds::Kind(boundary_kind<2>("Leaky walls")),
            beside ? "" : "0.001; 3");
      c.start();
      c.solver->discretisation.convection = false;
      for (unsigned int n = 0; n < 100; ++n)
        c.step(0.5);
      const double flux = c.solver->flux(beside ? 0 : 3);
      EXPECT_NEAR(c.solver->flux(2), -flux, 1e-7 * flux) << beside;
      if (!beside)
        {
          EXPECT_NEAR(flux, k * (13. - outside) * width, 1e-6 * flux);
          EXPECT_LT(c.error(1, [&](const Point<dim> &) { return k * (13. - outside); }), 1e-6 * k * 10.);
        }
    }
}


// Names, texts and ranges go the way that parameter files take.
TEST(BoundaryKind, IsReadFromParameters)
{
  const auto read = [](BoundaryConditions<dim> &conditions, const std::string &slip, const std::string &leaky) {
    ParameterHandler prm;
    conditions.add_parameters(prm);
    prm.enter_subsection("Boundary conditions");
    prm.set("Navier slip", slip);
    prm.set("Leaky walls", leaky);
    prm.set("No-slip walls", "right");
    prm.leave_subsection();
    conditions.initialize({{"left", 0}, {"right", 1}, {"top", 3}}, {{"d", 1e-3}});
  };
  const auto message = [&](const std::string &slip, const std::string &leaky) -> std::string {
    try
      {
        BoundaryConditions<dim> conditions;
        read(conditions, slip, leaky);
        for (const auto &[id, condition] : conditions.all())
          for (unsigned int c = 0; c < condition.kind->n_values(); ++c)
            conditions.value(condition, Point<dim>(0.5, 0.), c);
      }
    catch (const alluvium::UserError &error)
      {
        return error.what();
      }
    return "";
  };
  BoundaryConditions<dim> conditions;
  read(conditions, "left: 2*d*(1 + t)", "top: 0.1 | x");
  const auto &left = conditions.all().at(0), &top = conditions.all().at(3);
  EXPECT_EQ(left.kind->in_words(), "slip length");
  EXPECT_TRUE(conditions.fixes_pressure());
  EXPECT_TRUE(conditions.terms_depend_on_time());
  conditions.set_time(1.);
  EXPECT_DOUBLE_EQ(conditions.value(left, Point<dim>()), 4e-3);
  EXPECT_DOUBLE_EQ(conditions.value(top, Point<dim>(0.25, 0.), 1), 0.25);
  EXPECT_EQ(message("left: 1", "top: 1 | 1"), "");
  EXPECT_NE(message("left: 0", "top: 1 | 1").find("Boundary conditions/Navier slip: boundary 'left': '0' is 0 at"),
            std::string::npos);
  EXPECT_NE(message("left: 0", "top: 1 | 1").find("expected a slip length above 0"), std::string::npos);
  EXPECT_NE(message("left: 1", "top: -1 | 1").find("expected a conductance of at least 0"), std::string::npos);
  EXPECT_NE(message("left", "top: 1 | 1").find("Navier slip: expected `name: expression`"), std::string::npos);
  EXPECT_NE(message("left: 1", "top: 1").find("expected 2 expression(s)"), std::string::npos);
  EXPECT_NE(message("left: 1, right: 1", "top: 1 | 1"), "");
  EXPECT_NE(message("left: 1; right: 1", "top: 1 | 1").find("boundary 'right' already has another condition"),
            std::string::npos);
  EXPECT_NE(message("", "top: 1 | 1").find("boundary 'left' has none. Name it under one of 'Leaky walls', 'Navier"),
            std::string::npos);
}


INSTANTIATE_TEST_SUITE_P(Meshes,
                         BoundaryKinds,
                         testing::Values(Mesh::quadrilaterals, Mesh::hanging_nodes, Mesh::triangles),
                         name_of);
