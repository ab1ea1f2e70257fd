// Boundaries with a given pressure, against flows that are known exactly, on quadrilaterals, hanging nodes and
// triangles: streams, pipes and shear go on through them, what comes back brings no energy, and the energy balance
// closes.
#include "channel.h"

#include <deal.II/numerics/vector_tools.h>

namespace
{
  using namespace fluid_channel;

  /** A channel along y with slip sides and @p pressure below. */
  void open_ends(Channel &c, const boundary_kinds::Kind &sides, const std::string &pressure)
  {
    c.set(0, sides);
    c.set(1, sides);
    c.set(2, boundary_kinds::pressure, pressure);
    c.set(3, boundary_kinds::pressure, "0");
    c.start();
  }

  constexpr double pipe_speed = 0.05; // in the middle of a pipe under 1 Pa [m/s]: Re 100

  /** Plane Poiseuille flow between open ends, from rest until nothing changes. */
  void become_pipe(Channel &c)
  {
    open_ends(c, boundary_kinds::no_slip, "1");
    for (unsigned int n = 0; n < 100; ++n)
      c.step(0.2);
  }

  double parabola(const Point<dim> &x)
  {
    const double s = 2. * x[0] / width - 1.;
    return pipe_speed * (1. - s * s);
  }

  class OpenBoundaries : public testing::TestWithParam<Mesh>
  {
  };
} // namespace


// 1 MPa/m accelerate a stream: u = 1000 t, until u L rho/eta is 1e6. Without what open boundaries do it is lost at
// 1,700.
void expect_uniform_stream(const Mesh mesh, const double cell)
{
  const double allowed = 1e-6;
  Channel      c(mesh, cell);
  open_ends(c, boundary_kinds::slip, "10000");
  c.solver->linear_solver.tolerance = 1e-13; // what solves leave adds up over the steps
  const double dt                   = 1e-4;
  for (unsigned int n = 0; n < 1000; ++n)
    {
      c.step(dt);
      const double u = 1e3 * c.time;
      ASSERT_LT(c.largest(0), allowed * u) << "at " << c.time << " s, cells of " << cell << " m";
      ASSERT_LT(c.error(1, [&](const Point<dim> &) { return u; }), allowed * u)
        << "at " << c.time << " s, cells of " << cell << " m";
    }
}


TEST_P(OpenBoundaries, UniformStream)
{
  expect_uniform_stream(GetParam(), 1e-3);
}


TEST(OpenBoundariesValidation, UniformStreamOnFineCells)
{
  for (const double cell : {0.5e-3, 0.25e-3})
    expect_uniform_stream(Mesh::quadrilaterals, cell);
}


// The same in the other direction, and in steps of other lengths.
TEST_P(OpenBoundaries, UniformStreamFromAboveInOtherSteps)
{
  for (const double dt : {1e-2, 1e-3})
    {
      Channel c(GetParam(), 1e-3);
      open_ends(c, boundary_kinds::slip, "-10");
      for (unsigned int n = 0; n < 1000; ++n)
        c.step(dt);
      EXPECT_LT(c.error(1, [&](const Point<dim> &) { return -c.time; }), 1e-6 * c.time) << "steps of " << dt << " s";
    }
}


// Without the terms for it the same stream is lost: what they are there for.
TEST(OpenBoundary, NeedTheirTerms)
{
  Channel c(Mesh::quadrilaterals, 0.5e-3);
  c.terms = "none";
  open_ends(c, boundary_kinds::slip, "10");
  for (unsigned int n = 0; n < 300; ++n)
    c.step(1e-3);
  EXPECT_GT(c.error(1, [&](const Point<dim> &) { return c.time; }), c.time);
}


// A stream from fluid at rest: p + rho u^2/2 is given where it enters, so that u ends at sqrt(2 p/rho).
TEST_P(OpenBoundaries, TotalPressure)
{
  Channel          c(GetParam(), 0.5e-3);
  ParameterHandler prm;
  c.conditions.add_parameters(prm);
  prm.enter_subsection("Boundary conditions");
  prm.set("Pressure on inflow", "total");
  open_ends(c, boundary_kinds::slip, "10");
  for (unsigned int n = 0; n < 500; ++n)
    c.step(2e-3);
  const double u = std::sqrt(2. * 10. / rho);
  EXPECT_LT(c.error(1, [&](const Point<dim> &) { return u; }), 1e-5 * u);
}


// Plane Poiseuille flow between open ends at Re 100 is the parabola of the mesh, to the ends, and nothing goes
// sideways.
TEST(OpenBoundary, Poiseuille)
{
  for (const double cell : {0.5e-3, 0.2e-3})
    {
      Channel c(Mesh::quadrilaterals, cell);
      become_pipe(c);
      EXPECT_LT(c.largest(0), 1e-7 * pipe_speed) << "cells of " << cell << " m";
      EXPECT_LT(c.error(1, parabola), 1e-6 * pipe_speed) << "cells of " << cell << " m";
    }
}


// On triangles the parabola is not in the space: the flow converges with the mesh, in the corners too.
TEST(OpenBoundary, PoiseuilleOnTriangles)
{
  std::vector<double> errors;
  for (const double cell : {0.4e-3, 0.2e-3})
    {
      Channel c(Mesh::triangles, cell);
      become_pipe(c);
      errors.push_back(c.error(1, parabola) / pipe_speed);
    }
  EXPECT_LT(errors[1], 0.05);
  EXPECT_LT(errors[1], 0.6 * errors[0]);
}


// Plane Couette flow between open ends is linear.
TEST_P(OpenBoundaries, Couette)
{
  const double lid = 0.05;
  Channel      c(GetParam(), 0.5e-3);
  c.set(0, boundary_kinds::no_slip);
  c.set(1, boundary_kinds::velocity, "0; 0.05");
  c.set(2, boundary_kinds::pressure, "0");
  c.set(3, boundary_kinds::pressure, "0");
  c.start();
  for (unsigned int n = 0; n < 100; ++n)
    c.step(0.5);
  EXPECT_LT(c.largest(0), 1e-7 * lid);
  EXPECT_LT(c.error(1, [&](const Point<dim> &x) { return lid * x[0] / width; }), 1e-6 * lid);
}


// A vortex is carried out of the top by a stream: it never grows, and what balance does not explain is little.
TEST_P(OpenBoundaries, VortexLeaves)
{
  const double stream = 0.1, cell = GetParam() == Mesh::quadrilaterals ? 0.5e-3 : 1e-3, w = 0.02;
  Channel      c(GetParam(), cell, w, w);
  c.set(0, boundary_kinds::slip);
  c.set(1, boundary_kinds::slip);
  c.set(2, boundary_kinds::velocity, "0; 0.1");
  c.set(3, boundary_kinds::pressure, "0");
  c.start();
  // turning at up to 2.1 times the stream, so that there is backflow while it leaves
  const std::string   swirl = "exp(-((x-0.01)^2+(y-0.012)^2)/(2*0.002^2))/0.002*0.35";
  FunctionParser<dim> field(dim + 1);
  field.initialize("x,y", "-(y-0.012)*" + swirl + "; 0.1+(x-0.01)*" + swirl + "; 0", {});
  alluvium::fluid::BlockVector start = c.space.make_field();
  VectorTools::interpolate(c.space.mapping(), c.space.dof_handler(), field, start);
  c.solver->set_solution(start);
  double before = 1e300, gain = 0., exchanged = 0., backflow = 0.;
  for (unsigned int n = 0; n < 400; ++n)
    {
      c.step(1e-3);
      const EnergyBalance b = c.balance();
      if (n > 1)
        {
          EXPECT_LT(b.kinetic_energy, before * (1. + 1e-3)) << "at " << c.time << " s";
          gain += std::max(0., (b.kinetic_energy - b.kinetic_before) / 1e-3 - b.explained());
          exchanged += b.largest();
        }
      before = b.kinetic_energy;
      for (const auto &face : c.space.boundary().faces())
        for (unsigned int v = 0; v < c.space.n_nodes_per_cell(); ++v)
          backflow =
            std::max(backflow, -c.solver->solution().block(0).local_element(c.space.cells()[face.cell].velocity[v][1]));
    }
  EXPECT_GT(backflow, 0.1 * stream) << "the test shows nothing if nothing comes back";
  EXPECT_LT(gain, 0.03 * exchanged);
  EXPECT_LT(c.error(1, [&](const Point<dim> &) { return stream; }), 0.05 * stream) << "the stream is what is left";
}


// The energy balance closes to round-off for a stream, with the right parts.
TEST_P(OpenBoundaries, EnergyOfAStream)
{
  Channel c(GetParam(), 0.5e-3);
  open_ends(c, boundary_kinds::slip, "10");
  const double dt = 1e-3;
  for (unsigned int n = 0; n < 100; ++n)
    c.step(dt);
  const EnergyBalance b = c.balance();
  const double        u = 0.1, mass = rho * width * length;
  EXPECT_NEAR(b.kinetic_energy, mass * u * u / 2., 1e-6 * mass * u * u);
  EXPECT_NEAR(b.boundaries, 10. * width * u, 1e-6 * 10. * width * u);
  EXPECT_NEAR(b.time, mass * dt / 2., 1e-5 * mass * dt);
  EXPECT_NEAR((b.kinetic_energy - b.kinetic_before) / dt, b.explained(), 1e-7 * b.boundaries);
}


// In a pipe at rest in time, pressure's work is what viscosity takes.
TEST(OpenBoundary, EnergyOfAPipe)
{
  Channel c(Mesh::quadrilaterals, 0.2e-3);
  become_pipe(c);
  const EnergyBalance b = c.balance();
  EXPECT_NEAR(b.viscous, b.boundaries, 0.01 * b.boundaries); // the parabola of the mesh has 1 - 1/n^2 of its shear
  EXPECT_NEAR(b.explained(), 0., 1e-5 * b.boundaries);
}


INSTANTIATE_TEST_SUITE_P(Meshes,
                         OpenBoundaries,
                         testing::Values(Mesh::quadrilaterals, Mesh::hanging_nodes, Mesh::triangles),
                         name_of);
