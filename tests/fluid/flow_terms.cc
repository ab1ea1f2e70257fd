// The size of each term of the momentum equation, in a flow for which it is known.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/flow_terms.h>
#include <alluvium/fluid/vans_solver.h>

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/numerics/vector_tools.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace dealii;
  using namespace alluvium::fluid;

  constexpr double pi = numbers::PI, rho = 2., eta = 0.3, eps = 0.5, dt = 0.1;

  /** u = (sin(pi x) sin(pi y), 0), p = x. */
  struct Flow : Function<2>
  {
    Flow()
      : Function<2>(3)
    {}
    double value(const Point<2> &x, const unsigned int c) const override
    {
      return c == 0 ? std::sin(pi * x[0]) * std::sin(pi * x[1]) : c == 2 ? x[0] : 0.;
    }
  };
} // namespace

TEST(FlowTerms, AreThoseOfAKnownFlow)
{
  parallel::distributed::Triangulation<2> tria(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(tria);
  tria.refine_global(6);
  BoundaryConditions<2> bc;
  bc.set(0, {boundary_kinds::no_slip, "walls", nullptr});
  bc.pin(true);
  FluidSpace<2> space(tria);
  space.reinit(bc);
  VansSolver<2> solver(space);
  solver.reinit();
  auto void_fraction = space.make_nodal_field();
  void_fraction      = eps;
  void_fraction.update_ghost_values();
  auto flow = space.make_field(), before = space.make_field();
  VectorTools::interpolate(space.mapping(), space.dof_handler(), Flow(), flow);
  before.add(0.25, flow);
  flow.update_ghost_values();
  before.update_ghost_values();
  VansProblem<2> problem{};
  problem.fluid         = {rho, eta};
  problem.dt            = dt;
  problem.void_fraction = &void_fraction;

  const FlowTerms terms = flow_terms(space, problem, flow, before, solver.linear_solver.scales.volumes);
  // integrals over the square; nodes of the walls, half of their cells, are left out
  EXPECT_NEAR(terms.inertia / (eps * rho * 0.75 / dt * 0.5), 1., 0.01);
  EXPECT_NEAR(terms.convection / (eps * rho * pi * std::sqrt(3. / 64.)), 1., 0.02);
  EXPECT_NEAR(terms.viscosity / (eps * eta * pi * pi * std::sqrt(2.5)), 1., 0.02);
  EXPECT_NEAR(terms.pressure / eps, 1., 0.02);
  EXPECT_EQ(terms.largest(), terms.inertia);
}
