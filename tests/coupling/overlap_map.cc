#include "bed.h"

#include <gtest/gtest.h>

#include <random>

namespace
{
  using namespace bed;

  /** The pieces of @p grains, cut at once. */
  coupling::OverlapMap cut_at_once(const fluid::FluidSpace<2> &space, const grains::GrainArrays &grains)
  {
    coupling::OverlapMap map(space);
    map.reinit();
    map.cut(grains, {});
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
  }

  /** Some grains move a little, far, or over a seam; the rest keeps its pieces. */
  void keeps_what_stands(const bool periodic)
  {
    Bed      bed = random_bed(1, 20., 10.);
    Settings settings;
    settings.periodic = periodic;
    Channel              channel(bed.width, bed.height, bed.d, settings, 0.);
    coupling::OverlapMap map(channel.space);
    map.reinit();
    EXPECT_TRUE(map.cut(bed.grains, {}));
    EXPECT_FALSE(map.cut(bed.grains, {}));

    std::mt19937                           random(7);
    std::uniform_real_distribution<double> uniform(0., 1.);
    auto                                  &g = bed.grains;
    for (unsigned int round = 0; round < 3; ++round)
      {
        for (unsigned int k = 0; k < 5; ++k)
          {
            const auto i = static_cast<std::size_t>(uniform(random) * g.n());
            g.x[i]       = round == 2 && periodic ? 0.01 * bed.width : bed.width * uniform(random);
            g.y[i] += 0.1 * bed.d * (uniform(random) - 0.5);
          }
        EXPECT_TRUE(map.cut(g, {}));
        expect_same(map, cut_at_once(channel.space, g));
      }

    // less than the tolerance is not seen, its sum is
    const coupling::OverlapSettings tolerant{2., coupling::OverlapSettings::Rule::moments, 1e-3};
    g.x[3] += 0.8e-3 * 2. * g.radius[3];
    EXPECT_FALSE(map.cut(g, tolerant));
    g.x[3] += 0.8e-3 * 2. * g.radius[3];
    EXPECT_TRUE(map.cut(g, tolerant));
    expect_same(map, cut_at_once(channel.space, g));

    // other discs are other pieces
    coupling::OverlapSettings other{3., coupling::OverlapSettings::Rule::moments, 1e-3};
    const std::size_t         n = map.grain().size();
    EXPECT_TRUE(map.cut(g, other));
    EXPECT_GT(map.grain().size(), n);
    other.shape = coupling::OverlapSettings::Shape::smooth;
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
        bed.grains.id[k]     = k;
        bed.grains.x[k]      = (0.5 + k % 8) * bed.d;
        bed.grains.y[k]      = (0.5 + k / 8) * bed.d;
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
              if (g.x[i] > 3. * bed.d && g.x[i] < bed.width - 3. * bed.d && g.y[i] > 3. * bed.d &&
                  g.y[i] < bed.height - 3. * bed.d) // images aside
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
    keeps_what_stands(false);
  }

  TEST(OverlapMap, KeepsThePiecesOfGrainsThatStandBesideSeams)
  {
    keeps_what_stands(true);
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
    const auto &first = channel.space.cells()[0].vertex;
    bed.grains.x[0]   = first[1][0]; // between two cells
    bed.grains.y[0]   = 0.5 * (first[0][1] + first[2][1]);
    auto rule         = channel.coupling.settings;
    rule.rule         = coupling::OverlapSettings::Rule::centre;
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
