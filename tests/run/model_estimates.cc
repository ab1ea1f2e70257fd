// What each term of the model would change, from the numbers of a scene alone.
#include <alluvium/run/model_estimates.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace alluvium::run;

namespace
{
  constexpr double bound = 1e-3;

  TermEstimate of(const Term term, const SceneScales &scene, const std::vector<Term> &keep = {})
  {
    for (const TermEstimate &t : estimate_terms(scene, bound, keep))
      if (t.term == term)
        return t;
    return {};
  }

  /** Water through a fixed layer of sand under a constant head: the layer 1 cm, as much clear water above it. */
  SceneScales fixed_layer()
  {
    SceneScales s;
    s.is_driven    = true;
    s.grains_move  = false;
    s.in_layers    = true;
    s.diameter     = 2e-4;
    s.permeability = 1e-10;
    s.eps          = 0.5;
    s.bed_height = s.clear_height = s.width = 0.01;
    s.velocity                              = 1e-4;
    s.first_row                             = 0.01;
    return s;
  }

  /** A few grains of 0.2 mm in a box of 1 cm. */
  SceneScales suspension(const double viscosity)
  {
    SceneScales s;
    s.viscosity      = viscosity;
    s.is_suspension  = true;
    s.iterates       = true;
    s.width          = 0.01;
    s.diameter       = 2e-4;
    s.density_ratio  = 2.63;
    s.packing        = 0.02;
    s.smallest_eps   = 0.9;
    s.settling_speed = s.velocity = 1630. * 9.81 * 4e-8 / (18. * viscosity);
    s.gap                         = 2e-4;
    s.friction                    = 0.4;
    s.first_row                   = 0.01;
    return s;
  }
} // namespace

TEST(ModelEstimates, TermsComeInTheirOrderEachWithAReason)
{
  for (const SceneScales &s : {fixed_layer(), suspension(1e-3), SceneScales()})
    {
      const auto terms = estimate_terms(s, bound);
      ASSERT_EQ(terms.size(), all_terms.size());
      for (std::size_t i = 0; i < terms.size(); ++i)
        {
          EXPECT_EQ(terms[i].term, all_terms[i]);
          EXPECT_FALSE(terms[i].because.empty()) << name_of(terms[i].term);
        }
    }
}

TEST(ModelEstimates, LayerAtLowReynoldsNumberIsDarcys)
{
  const SceneScales s = fixed_layer();
  // rho K (L + eps L_c) / (eta eps L)
  const double time = 1000. * 1e-10 * 0.015 / (1e-3 * 0.5 * 0.01);
  EXPECT_NEAR(time, 3e-4, 1e-12);
  EXPECT_NEAR(of(Term::inertia, s).estimate, std::exp(-0.01 / time), 1e-20);
  EXPECT_FALSE(of(Term::inertia, s).on);
  EXPECT_NEAR(of(Term::convection, s).estimate, 1000. * 1e-4 * 1e-10 * 0.75 / (1e-3 * 0.5 * 0.01), 1e-12);
  EXPECT_FALSE(of(Term::contacts, s).on);
  EXPECT_FALSE(of(Term::iteration, s).on);
  EXPECT_TRUE(of(Term::viscous_stress, s).on); // for the clear water
  EXPECT_TRUE(of(Term::fluid, s).on);
}

TEST(ModelEstimates, LayerFeelsInertiaWhereTheHeadChangesFastOrRowsComeEarly)
{
  SceneScales s  = fixed_layer();
  s.driving_time = 0.1;
  EXPECT_NEAR(of(Term::inertia, s).estimate, 3e-3, 1e-6);
  EXPECT_TRUE(of(Term::inertia, s).on);
  s.driving_time = 10.;
  EXPECT_FALSE(of(Term::inertia, s).on);
  s.first_row = 1e-3;
  EXPECT_NEAR(of(Term::inertia, s).estimate, std::exp(-1. / 0.3) + 3e-5, 1e-6);
  EXPECT_TRUE(of(Term::inertia, s).on);
}

TEST(ModelEstimates, DarcysNumberDecidesOnViscousStress)
{
  SceneScales s     = fixed_layer();
  s.has_clear_fluid = false;
  EXPECT_NEAR(of(Term::viscous_stress, s).estimate, 1e-6, 1e-12);
  EXPECT_FALSE(of(Term::viscous_stress, s).on);
  s.has_no_slip = true;
  EXPECT_NEAR(of(Term::viscous_stress, s).estimate, 1e-3, 1e-9);
}

TEST(ModelEstimates, ReynoldsNumberOfTheBoxDecidesInSuspensions)
{
  SceneScales water = suspension(1e-3), glycerine = suspension(1.5);
  EXPECT_TRUE(of(Term::inertia, glycerine).on); // the start from rest is in its first row
  water.first_row = glycerine.first_row = 1.;
  EXPECT_TRUE(of(Term::convection, water).on);
  EXPECT_TRUE(of(Term::inertia, water).on);
  const double re = 1000. * glycerine.velocity * 0.01 / 1.5;
  EXPECT_LT(re, bound);
  EXPECT_NEAR(of(Term::convection, glycerine).estimate, re, 1e-12);
  EXPECT_NEAR(of(Term::inertia, glycerine).estimate, re / (M_PI * M_PI), 1e-12);
  EXPECT_FALSE(of(Term::convection, glycerine).on);
  EXPECT_FALSE(of(Term::inertia, glycerine).on);
  // added mass is the fluid's inertia
  SceneScales s = glycerine;
  s.added_mass  = 0.5;
  EXPECT_TRUE(of(Term::inertia, s).on);
  EXPECT_TRUE(of(Term::added_mass, s).on);
  s.density_ratio = 2000.;
  EXPECT_FALSE(of(Term::added_mass, s).on);
}

TEST(ModelEstimates, ContactsWaitUntilSomethingIsNear)
{
  SceneScales s = suspension(1e-3);
  s.dt          = 1e-4;
  EXPECT_FALSE(of(Term::contacts, s).on);
  EXPECT_FALSE(of(Term::friction, s).on);
  EXPECT_FALSE(of(Term::rotation, s).on);
  s.gap = 1e-9;
  EXPECT_TRUE(of(Term::contacts, s).on);
  EXPECT_TRUE(of(Term::friction, s).on);
  EXPECT_TRUE(of(Term::rotation, s).on);
  s.friction = 0.;
  EXPECT_FALSE(of(Term::friction, s).on);
  EXPECT_FALSE(of(Term::rotation, s).on);
  s              = suspension(1e-3);
  s.may_be_apart = false;
  EXPECT_TRUE(of(Term::contacts, s).on);
}

TEST(ModelEstimates, IterationIsForDenseOrFastGrains)
{
  SceneScales s     = suspension(1e-3);
  s.dt              = 1e-4;
  const double path = s.settling_speed * s.dt / s.diameter;
  EXPECT_NEAR(of(Term::iteration, s).estimate, 0.5 * std::sqrt(0.02) * path * path, 1e-12);
  EXPECT_FALSE(of(Term::iteration, s).on);
  s.dt = 2e-3;
  EXPECT_TRUE(of(Term::iteration, s).on);
  s.dt           = 1e-4;
  s.smallest_eps = 0.5;
  EXPECT_TRUE(of(Term::iteration, s).on);
  s.smallest_eps  = 0.9;
  s.is_suspension = false;
  EXPECT_TRUE(of(Term::iteration, s).on);
}

namespace
{
  /**
   * Growth in a step of what is wrong in a homogeneous suspension without net flux, if each step is solved once: the
   * scheme per grain, lagged with the fields of t^n, with rho = 1 and time in units of tau_p.
   */
  double growth(const double eps, const double s, const double dt)
  {
    const double gamma = s, c = 1. / (s / dt + gamma), phi = 1. - eps;
    // one step of (u, g, v): fluid, reduced pressure gradient, grains. The first two follow from
    //   v* - c/2 (gamma u' - g') = c s v/dt + c/2 (gamma u - g),   eps u' + phi v* = 0,
    //   (eps/dt + phi gamma) u' + eps g' - phi gamma v* = eps u/dt
    const auto step = [&](const std::array<double, 3> &x) {
      const double known = c * s * x[2] / dt + 0.5 * c * (gamma * x[0] - x[1]);
      // v* = -eps u'/phi; g' from the third equation into the first one
      const double of_u = (eps / dt + phi * gamma + eps * gamma) / eps; // g' = u/dt - of_u u'
      const double u    = (known - 0.5 * c * x[0] / dt) / (-eps / phi - 0.5 * c * (gamma + of_u));
      const double g    = x[0] / dt - of_u * u;
      return std::array<double, 3>{{u, g, c * (s * x[2] / dt + gamma * u - g)}};
    };
    std::array<double, 3> x          = {{1., 0.3, -0.7}};
    double                log_growth = 0.;
    constexpr int         n = 4000, n_first = 1000;
    for (int i = 0; i < n; ++i)
      {
        x                 = step(x);
        const double size = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        log_growth += i < n_first ? 0. : std::log(size) / (n - n_first);
        for (double &value : x)
          value /= size;
      }
    return std::exp(log_growth);
  }
} // namespace

TEST(ModelEstimates, StepsSolvedOnceAreStableAboveTheLimit)
{
  for (const double s : {1., 1.1, 2.63, 10., 2000.})
    for (const double eps : {least_eps_without_iteration, 0.7, 0.95})
      for (const double dt : {1e-2, 0.1, 0.3, 1., 3., 10., 100.})
        EXPECT_LT(growth(eps, s, dt), 1. - 1e-4) << "eps " << eps << ", s " << s << ", dt/tau " << dt;
  EXPECT_GT(growth(0.48, 1., 0.2), 1.01); // why there is a limit
  EXPECT_GT(growth(0.4, 2.63, 1.), 1.01);
  SceneScales light   = suspension(1e-3);
  light.dt            = 1e-4;
  light.density_ratio = 0.9;
  EXPECT_TRUE(of(Term::iteration, light).on);
}

TEST(ModelEstimates, FluidGoesWhereItNeitherLiftsNorDrags)
{
  SceneScales s   = suspension(1.8e-5);
  s.density       = 1.2;
  s.density_ratio = 6500.;
  s.drag_of_fall  = 5e-4;
  EXPECT_FALSE(of(Term::fluid, s).on);
  for (const Term term : {Term::convection, Term::two_way_coupling, Term::iteration, Term::adaptivity})
    EXPECT_FALSE(of(term, s).on) << name_of(term);
  s.drag_of_fall = 5e-3;
  EXPECT_TRUE(of(Term::fluid, s).on);
  s.drag_of_fall = 5e-4;
  s.is_driven    = true;
  EXPECT_TRUE(of(Term::fluid, s).on);
  s.is_driven = false;
  // with the fluid that is kept come its terms
  s.is_driven = false;
  EXPECT_TRUE(of(Term::fluid, s, {Term::fluid}).on);
  EXPECT_TRUE(of(Term::two_way_coupling, s, {Term::fluid}).on);
  s.density_ratio = 500.; // buoyancy
  EXPECT_TRUE(of(Term::fluid, s).on);
}

TEST(ModelEstimates, MeshStaysWithFixedGrainsUnlessItAsksTheFlow)
{
  SceneScales s            = fixed_layer();
  s.mesh_follows           = true;
  s.mesh_asks_grains_alone = true;
  EXPECT_FALSE(of(Term::adaptivity, s).on);
  s.mesh_asks_grains_alone = false;
  EXPECT_TRUE(of(Term::adaptivity, s).on);
  s.mesh_asks_grains_alone = true;
  s.grains_move            = true;
  EXPECT_TRUE(of(Term::adaptivity, s).on);
}

TEST(ModelEstimates, WhatIsKeptStaysAndWhatIsNotAskedForIsNotKept)
{
  SceneScales s = fixed_layer();
  EXPECT_TRUE(of(Term::inertia, s, {Term::inertia}).on);
  EXPECT_FALSE(of(Term::convection, s, {Term::inertia}).on);
  s.inertia = false;
  EXPECT_FALSE(of(Term::inertia, s, {Term::inertia}).on);
  EXPECT_FALSE(of(Term::added_mass, s, {Term::added_mass}).on);
}
