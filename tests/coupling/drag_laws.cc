// The registered drag laws: against numbers worked out from the published formulas, in the normalisation of each paper,
// with 30 digits; over the whole range that they may be asked for; and what a homogeneous bed makes of them.
#include "named_law.h"

#include <alluvium/coupling/homogeneous_bed.h>

#include <gtest/gtest.h>

#include <limits>

namespace
{
  using bed::coupling::DragLaw;
  using bed::coupling::DragState;
  using Registry = alluvium::Registry<DragLaw>;

  using bed::d, bed::rho, bed::eta, bed::Law;

  /** The slip at which the Reynolds number is @p re. */
  double slip(const double eps, const double re)
  {
    return re * eta / (eps * rho * d);
  }
} // namespace

TEST(DragLaws, PublishedNumbers)
{
  struct Number
  {
    const char *law;
    double      eps, slip, gamma; // [m/s], [N s/m^4] for the d, rho, eta above
  };
  const std::vector<Number> numbers = {
    {"Ergun", 0.48, 0.02, 3516528.92561983},    {"Ergun", 0.7, 0.1, 2123671.78276269},
    {"Ergun", 0.9, 0.4, 3526170.79889807},      {"Ergun", 0.5, 12., 98553719.0082645},
    {"Wen-Yu", 0.48, 0.02, 3253054.53364171},   {"Wen-Yu", 0.7, 0.1, 1896378.96858015},
    {"Wen-Yu", 0.9, 0.4, 1978302.14335609},     {"Wen-Yu", 0.5, 12., 56490055.0485661},
    {"Gidaspow", 0.48, 0.02, 3516528.92561983}, {"Gidaspow", 0.7, 0.1, 2123671.78276269},
    {"Gidaspow", 0.9, 0.4, 1978302.14335609},   {"Gidaspow", 0.5, 12., 98553719.0082645},
    {"Beetstra", 0.48, 0.02, 4135597.95742585}, {"Beetstra", 0.7, 0.1, 2366877.31209125},
    {"Beetstra", 0.9, 0.4, 2489932.13657243},   {"Beetstra", 0.5, 12., 62308317.8431659},
    {"Tang", 0.48, 0.02, 4492528.41798768},     {"Tang", 0.7, 0.1, 2528671.22108156},
    {"Tang", 0.9, 0.4, 2430325.3641031},        {"Koch-Hill", 0.48, 0.02, 4127376.57739107},
    {"Koch-Hill", 0.7, 0.1, 2097137.37792517},  {"Koch-Hill", 0.9, 0.4, 2374880.05342555},
    {"Koch-Hill", 0.5, 12., 59909690.0826446},  {"Rong", 0.48, 0.02, 3180441.00561163},
    {"Rong", 0.7, 0.1, 1780235.87157039},       {"Rong", 0.9, 0.4, 2167062.39744369},
    {"Rong", 0.5, 12., 79165300.775234},        {"Tang", 0.5, 9., 24835869.7884717}};
  for (const Number &n : numbers)
    EXPECT_NEAR(Law(n.law).gamma(n.eps, n.slip) / n.gamma, 1., 1e-10) << n.law << " at eps " << n.eps;
}

TEST(DragLaws, ShapeAndFactor)
{
  for (const std::string name : {"Ergun", "Wen-Yu", "Gidaspow", "Beetstra", "Tang", "Koch-Hill", "Rong"})
    {
      Law          law(name);
      const double sphere = law.gamma(0.5, 0.01);
      law.prm.set("Shape", "disc");
      // as Dallavalle's law for a disc over that for a sphere
      EXPECT_NEAR(law.gamma(0.5, 0.01) / sphere, Law("disc").gamma(0.5, 0.01) / Law("sphere").gamma(0.5, 0.01), 1e-13);
      law.prm.set("Factor", 3.);
      EXPECT_NEAR(law.gamma(0.5, 0.01) / sphere, 3. * 8. / (3. * dealii::numbers::PI), 1e-13) << name;
    }
}

TEST(DragLaws, PositiveFiniteAndRisingEverywhere)
{
  for (const auto &entry : Registry::entries())
    {
      const Law law(entry.first);
      for (double eps = 0.05; eps <= 1.0001; eps += 0.05)
        {
          const double e = std::min(eps, 1.), stokes = law.gamma(e, 0.);
          EXPECT_GT(stokes, 0.) << entry.first << " eps " << e;
          EXPECT_TRUE(std::isfinite(stokes)) << entry.first << " eps " << e;
          // no jump where creeping flow ends
          EXPECT_NEAR(law.gamma(e, slip(e, 1e-9)) / stokes, 1., 1e-3) << entry.first << " eps " << e;
          for (double re = 1e-3; re < 1.01e4; re *= std::sqrt(10.))
            {
              const double gamma = law.gamma(e, slip(e, re));
              EXPECT_TRUE(std::isfinite(gamma)) << entry.first << " eps " << e << " Re " << re;
              // the force rises with the slip
              EXPECT_GT(gamma * re, law.gamma(e, slip(e, 0.5 * re)) * 0.5 * re)
                << entry.first << " eps " << e << " Re " << re;
            }
        }
    }
}

TEST(DragLaws, StokesDragOfALoneSphere)
{
  const double stokes = 18. * eta / (d * d);
  for (const std::string name : {"Ergun", "Wen-Yu", "Gidaspow", "Beetstra", "Tang", "Koch-Hill"})
    EXPECT_NEAR(Law(name).gamma(1., 0.) / stokes, 1., 1e-12) << name;
  // Dallavalle's coefficient tends to 4.8^2 / Re, not to 24 / Re
  for (const std::string name : {"sphere", "Rong"})
    EXPECT_NEAR(Law(name).gamma(1., 0.) / stokes, 0.96, 1e-12) << name;
}

TEST(DragLaws, HomogeneousBed)
{
  bed::grains::GrainArrays grains;
  grains.resize(3);
  for (unsigned int i = 0; i < 3; ++i)
    {
      grains.radius[i] = grains.fluid_radius[i] = 0.5 * d;
      grains.mass[i]                            = 2630. * dealii::numbers::PI * d * d / 4.;
    }
  bed::fluid::FluidProperties fluid;
  fluid.density                           = rho;
  fluid.viscosity                         = eta;
  const double                        eps = 0.48, phi = 1. - eps, g = 9.81;
  const bed::coupling::HomogeneousBed homogeneous{grains, fluid, eps};
  const Law                           ergun("Ergun");
  EXPECT_NEAR(homogeneous.permeability(*ergun.law) / (eps * eps * eps * d * d / (150. * phi * phi)), 1., 1e-12);
  // a U^2 + b U = phi (rho_p - rho) g
  const double a = 1.75 * phi * rho / (eps * eps * eps * d), b = 150. * phi * phi * eta / (eps * eps * eps * d * d),
               c     = phi * (2630. - rho) * g;
  const double exact = (-b + std::sqrt(b * b + 4. * a * c)) / (2. * a);
  EXPECT_NEAR(homogeneous.fluidisation_velocity(*ergun.law, g) / exact, 1., 1e-12);
  // in very viscous fluid, weight over resistance: U = K phi (rho_p - rho) g / eta for every law
  fluid.viscosity = 1e3;
  for (const auto &entry : Registry::entries())
    {
      const Law law(entry.first);
      EXPECT_NEAR(homogeneous.fluidisation_velocity(*law.law, g) /
                    (homogeneous.permeability(*law.law) * c / fluid.viscosity),
                  1.,
                  1e-2)
        << entry.first;
    }
  // a grain of infinite mass is held: the others are carried as if alone with it
  const double all = homogeneous.fluidisation_velocity(*ergun.law, g);
  grains.mass[1]   = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(homogeneous.fluidisation_velocity(*ergun.law, g) / all, 2. / 3., 1e-6);
  grains.mass[1] = grains.mass[0];
  EXPECT_TRUE(homogeneous.has_drag(*ergun.law));
  for (const char *name : {"disc", "Ergun"}) // without drag nothing is carried, and nothing is infinite
    {
      Law none(name);
      none.prm.set("Factor", 0.);
      EXPECT_FALSE(homogeneous.has_drag(*none.law));
      EXPECT_EQ(homogeneous.fluidisation_velocity(*none.law, g), 0.);
      EXPECT_EQ(homogeneous.permeability(*none.law), 0.);
      EXPECT_EQ(homogeneous.relaxation_time(*none.law), 0.);
    }
  for (double &m : grains.mass)
    m *= 0.3; // lighter than the fluid
  EXPECT_EQ(homogeneous.fluidisation_velocity(*ergun.law, g), 0.);
}

TEST(DragLaws, GrainsOutsideTheRangeAreNamed)
{
  bed::Settings s;
  s.filter = 0.;
  bed::grains::GrainArrays g;
  g.resize(2);
  for (unsigned int i = 0; i < 2; ++i)
    {
      g.id[i]          = 7 + i;
      g.position[0][i] = (2.5 + 5. * i) * d; // the second in a dense corner of its own
      g.position[1][i] = 2.5 * d;
      g.radius[i] = g.fluid_radius[i] = (i == 0 ? 0.2 : 2.) * d;
      g.mass[i]                       = 1.;
    }
  for (const std::string name : {"Ergun", "Wen-Yu"})
    {
      s.drag = name;
      bed::Channel channel(10. * d, 5. * d, 5. * d, s, 0.);
      channel.step(g, true);
      const auto ids = channel.coupling.outside_drag_range(g);
      if (name == "Ergun") // void fractions of about 0.99 and 0.5 in two cells, smoothed between their nodes
        EXPECT_EQ(ids, std::vector<bed::grains::GrainId>({7})) << name;
      else
        EXPECT_TRUE(ids.empty()) << name;
    }
}
