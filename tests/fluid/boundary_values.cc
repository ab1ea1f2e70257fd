// What boundary conditions hold of the unknowns: which condition wins where several meet, slip along slopes, values
// that change in time.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/fluid_space.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace dealii;
  using namespace alluvium::fluid;

  const auto zero = std::make_shared<Functions::ZeroFunction<2>>(2);

  /** A square of 4 x 4 cells, turned by an angle, with sides 0 to 3: left, right, bottom, top before the turn. */
  struct Square
  {
    explicit Square(const double angle = 0.)
    {
      GridGenerator::subdivided_hyper_cube(mesh, 4, 0., 4., true);
      GridTools::rotate(angle, mesh);
    }

    void set(const std::array<BoundaryConditions<2>::Condition, 4> &sides)
    {
      for (unsigned int id = 0; id < 4; ++id)
        bc.set(id, sides[id]);
      space.attach(mesh);
      space.reinit(bc);
      DoFTools::map_dofs_to_support_points(space.mapping(), space.nodal_dof_handler(), place);
    }

    /** The nodal unknown at @p p. */
    types::global_dof_index node(const Point<2> &p) const
    {
      for (const auto &[dof, x] : place)
        if (x.distance(p) < 1e-10)
          return dof;
      ADD_FAILURE() << "no node at " << p;
      return 0;
    }

    /** Is component @p c (2: pressure) held at @p p? */
    bool holds(const Point<2> &p, const unsigned int c) const
    {
      const auto n = node(p);
      return space.constraints().is_constrained(c == 2 ? space.first_pressure() + n : 2 * n + c);
    }

    Triangulation<2>                            mesh;
    BoundaryConditions<2>                       bc;
    FluidSpace<2>                               space;
    std::map<types::global_dof_index, Point<2>> place;
  };
} // namespace

TEST(BoundaryNodes, WhoWinsAtCorners)
{
  Square s;
  s.set({{{boundary_kinds::no_slip, "left", nullptr},
          {boundary_kinds::slip, "right", nullptr},
          {boundary_kinds::velocity, "bottom", zero},
          {boundary_kinds::pressure, "top", std::make_shared<Functions::ZeroFunction<2>>(1)}}});
  const auto expect = [&](const double x, const double y, const bool u, const bool v, const bool p, const bool given) {
    const Point<2> at(x, y);
    EXPECT_EQ(s.holds(at, 0), u) << at;
    EXPECT_EQ(s.holds(at, 1), v) << at;
    EXPECT_EQ(s.holds(at, 2), p) << at;
    EXPECT_EQ(s.space.boundary().inflow_nodes().count(s.node(at)), given ? 1u : 0u) << at;
  };
  expect(0., 2., true, true, false, false); // along each side
  expect(4., 2., true, false, false, false);
  expect(2., 0., true, true, false, true);
  expect(2., 4., false, false, true, false);
  expect(0., 0., true, true, false, false); // the wall wins over the inflow,
  expect(4., 0., true, true, false, true);  // the inflow over slip,
  expect(0., 4., true, true, true, false);  // and a wall's end may be open
  expect(4., 4., true, false, true, false);
  expect(2., 2., false, false, false, false);
}

TEST(BoundaryNodes, SlipAlongASlope)
{
  const double angle = 0.4;
  Square       s(angle);
  const auto   slip = BoundaryConditions<2>::Condition{boundary_kinds::slip, "side", nullptr};
  s.bc.pin(true);
  s.set({{slip, slip, slip, slip}});
  const Tensor<1, 2> along({std::cos(angle), std::sin(angle)}), across({-std::sin(angle), std::cos(angle)});
  // a flow along the bottom fulfils the constraints of its nodes, one through it does not
  const auto             n = s.node(Point<2>(2. * along));
  dealii::Vector<double> u(s.space.n_dofs());
  const auto             distributed = [&](const Tensor<1, 2> &flow) {
    u            = 0.;
    u(2 * n)     = flow[0];
    u(2 * n + 1) = flow[1];
    s.space.constraints().distribute(u);
    return Tensor<1, 2>({u(2 * n), u(2 * n + 1)});
  };
  EXPECT_LT((distributed(along) - along).norm(), 1e-14);
  EXPECT_NEAR(distributed(across) * across, 0., 1e-14);
  EXPECT_GT((distributed(across) - across).norm(), 0.1);
  // at a corner nothing can flow
  for (const auto &corner : {Point<2>(), Point<2>(4. * along), Point<2>(4. * along + 4. * across)})
    EXPECT_TRUE(s.holds(corner, 0) && s.holds(corner, 1)) << corner;
}

TEST(BoundaryNodes, PressuresThatMeetShareTheNode)
{
  Square     s;
  const auto p = std::make_shared<Functions::ZeroFunction<2>>(1);
  s.set({{{boundary_kinds::pressure, "left", p},
          {boundary_kinds::slip, "right", nullptr},
          {boundary_kinds::slip, "bottom", nullptr},
          {boundary_kinds::pressure, "top", p}}});
  // together they weigh the corner once
  double of_corner = 0.;
  for (const types::boundary_id id : {0, 3})
    for (const auto &w : s.space.boundary().weights_at(id))
      for (unsigned int v = 0; v < 4; ++v)
        if (Point<2>(s.space.cells()[w.cell].vertex[v][0], s.space.cells()[w.cell].vertex[v][1])
              .distance(Point<2>(0., 4.)) < 1e-10)
          of_corner += w.weight[v];
  EXPECT_NEAR(of_corner, 1., 1e-14);
}

TEST(BoundaryValues, FollowTime)
{
  class Rising : public Function<2>
  {
  public:
    double value(const Point<2> &x, const unsigned int = 0) const override { return (10. + x[0]) * get_time(); }
  };
  Square s;
  s.set({{{boundary_kinds::slip, "left", nullptr},
          {boundary_kinds::slip, "right", nullptr},
          {boundary_kinds::velocity, "bottom", zero},
          {boundary_kinds::pressure, "top", std::make_shared<Rising>()}}});
  const auto                                &boundary = s.space.boundary();
  const Tensor<1, 2>                         hydrostatic({0., -100.}); // rho g [Pa/m]
  const std::map<types::boundary_id, double> deficits{{3, 0.25}};
  BoundaryValues<2>::GivenVelocities         velocities;
  for (const auto &[node, inflow] : boundary.inflow_nodes())
    velocities[node] = Tensor<1, 2>({0., 2. + inflow.point[0]});
  auto field = s.space.make_field();
  s.bc.set_time(0.5);
  // as the datum the pressure of a node of the top: of rho g.x it leaves only what differs from it
  const double datum = boundary.pressure_datum(s.bc, hydrostatic);
  EXPECT_GE(datum, 405.);
  EXPECT_LE(datum, 407.);
  const auto apply = [&] { boundary.apply_boundary_values(s.bc, hydrostatic, datum, deficits, velocities, field); };
  const auto has = [&] { return boundary.has_boundary_values(s.bc, hydrostatic, datum, deficits, velocities, field); };
  EXPECT_FALSE(has());
  apply();
  EXPECT_TRUE(has());
  for (const double t : {0.5, 0.7})
    {
      s.bc.set_time(t);
      EXPECT_EQ(has(), t == 0.5);
      apply();
      EXPECT_TRUE(has());
      for (const double x : {0., 1., 4.})
        EXPECT_NEAR(field.block(1)(s.node(Point<2>(x, 4.))), (10. + x) * t + 400. - datum - 0.25, 1e-11)
          << x << ' ' << t;
      EXPECT_EQ(field.block(0)(2 * s.node(Point<2>(1., 0.)) + 1), 3.);
    }
  EXPECT_EQ(field.block(1)(s.node(Point<2>(2., 2.))), 0.); // inside nothing is given
  // one that is no number is named
  class Broken : public Function<2>
  {
  public:
    double value(const Point<2> &, const unsigned int = 0) const override { return std::sqrt(-1. - get_time()); }
  };
  s.bc.set(3, {boundary_kinds::pressure, "top", std::make_shared<Broken>()});
  EXPECT_THROW(apply(), alluvium::UserError);
}
