#include "bed.h"

#include <alluvium/coupling/flow_totals.h>

#include <gtest/gtest.h>

#include <set>

namespace
{
  using namespace bed;

  /** Totals of the velocity (a x, b) [m/s], on cells of different sizes with hanging nodes. */
  struct Flow
  {
    Flow(const Bed &bed, const double h_over_d, const double a, const double b)
      : channel(bed.width, bed.height, h_over_d * bed.d, graded(h_over_d), 0.)
    {
      channel.coupling.update_void_fraction(bed.grains);
      auto field = channel.space.make_field();
      for (const auto &cell : channel.space.cells())
        for (unsigned int v = 0; v < 4; ++v)
          {
            field.block(0).local_element(cell.velocity[v][0]) = a * cell.vertex[v][0];
            field.block(0).local_element(cell.velocity[v][1]) = b;
          }
      channel.solver.set_solution(field);
      totals = coupling::flow_totals(channel.coupling, channel.space, channel.solver, channel.bc, bed.grains);
    }

    static Settings graded(const double h_over_d)
    {
      Settings settings;
      settings.h_over_d = h_over_d;
      settings.graded   = true;
      return settings;
    }

    Channel              channel;
    coupling::FlowTotals totals;
  };

  TEST(FlowTotals, KeepSolidAndMomentumOnAnyMesh)
  {
    const Bed bed   = random_bed(1, 16., 16.);
    double    solid = 0.;
    for (const double r : bed.grains.fluid_radius)
      solid += M_PI * r * r;
    for (const double h : {4., 1., 0.5})
      {
        const Flow flow(bed, h, 0., 0.01);
        EXPECT_NEAR(flow.totals.solid_volume / solid, 1., 1e-12);
        EXPECT_NEAR(flow.totals.momentum[0], 0., 1e-20);
        EXPECT_NEAR(flow.totals.momentum[1] / (1000. * 0.01 * (bed.width * bed.height - solid)), 1., 1e-12);
      }
  }

  TEST(FlowTotals, TheMassResidualIsTheDivergence)
  {
    Bed bed;
    bed.width = bed.height = 16. * (bed.d = 2e-4);
    bed.grains.resize(1); // there must be one; it has hardly any volume
    bed.grains.position[0][0] = bed.grains.position[1][0] = 0.3 * bed.width;
    bed.grains.radius[0] = bed.grains.fluid_radius[0] = 1e-7 * bed.d;
    // a uniform flow has none, and what diverges at the rate a gains a times its volume at each node
    EXPECT_NEAR(Flow(bed, 1., 0., 0.01).totals.mass_residual, 0., 1e-12);
    const double           a = 3.;
    const Flow             flow(bed, 1., a, 0.);
    const auto            &volumes = flow.channel.space.node_volumes();
    std::set<unsigned int> inside;
    for (const auto &cell : flow.channel.space.cells())
      for (unsigned int v = 0; v < 4; ++v)
        if (const auto &x = cell.vertex[v];
            std::min({x[0], x[1], bed.width - x[0], bed.height - x[1]}) > 1e-9 * bed.width)
          inside.insert(cell.node[v]);
    double square = 0.;
    for (const unsigned int node : inside)
      square += volumes.local_element(node) * volumes.local_element(node);
    const double flux = std::sqrt(bed.width * bed.width * bed.width * bed.height / 3.);
    EXPECT_NEAR(flow.totals.mass_residual, std::sqrt(square) / flux, 1e-12);
    EXPECT_NEAR(flow.totals.momentum[0] / (1000. * a * 0.5 * bed.width * bed.width * bed.height), 1., 1e-12);
  }

  TEST(FlowTotals, GrainsThatMoveWithTheFluidMakeUpForItsVoids)
  {
    // in the middle of clear water
    Bed bed = random_bed(1, 16., 16.);
    for (double &y : bed.grains.position[1])
      y += 0.5 * bed.height;
    bed.height *= 2.;
    const double still = Flow(bed, 1., 0., 0.01).totals.mass_residual;
    for (double &v : bed.grains.velocity[1])
      v = 0.01;
    // what lumping the void fraction leaves on cells of up to 4 d is less than half
    EXPECT_LT(Flow(bed, 1., 0., 0.01).totals.mass_residual, 0.6 * still);
  }
} // namespace
