// Contact laws that change coefficients from contact to contact, against exact answers.
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include <limits>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  constexpr double mu_k = 0.3, ratio = 1.25, v_0 = 1e-3;

  double mu(const double v)
  {
    return mu_k * (1. + (ratio - 1.) * std::exp(-std::abs(v) / v_0));
  }

  const std::string law = "set Contact law = static-kinetic\n"
                          "set Friction coefficient = 0.3\nset Wall friction coefficient = 0.3\n"
                          "subsection Contact law: static-kinetic\n"
                          " set Static friction ratio = 1.25\n set Transition slip speed = 1e-3\nend\n";

  /** A block on a floor turned by @p angle, with speed @p v down it. */
  struct Block : Scene
  {
    explicit Block(const double angle, const double v = 0., const double belt = 0.)
    {
      set(law + "set Grains rotate = false\nset Residual tolerance = 1e-13\nset Largest violation = 1e-13\n"
                "set Steps to rest = 0\n");
      floor({{belt, 0.}});
      incline(angle);
      add(0., r, v);
    }
  };
} // namespace

TEST(StaticKineticLaw, BlockStartsAtTheStaticAngleAndSlidesWithKineticFriction)
{
  const double angle = std::atan(mu_k * ratio), dt = 1e-4;
  Block        below(angle - 1e-6), above(angle + 1e-6);
  below.step(dt, 300);
  EXPECT_NEAR(below.grains.velocity[0][0], 0., 1e-15);
  EXPECT_NEAR(below.grains.position[0][0], 0., 1e-15);

  above.step(dt, 900);
  EXPECT_GT(above.grains.velocity[0][0], 40. * v_0);
  const double before = above.grains.velocity[0][0];
  above.step(dt, 100);
  const double a = g * (std::sin(angle + 1e-6) - mu_k * std::cos(angle + 1e-6));
  EXPECT_NEAR(above.grains.velocity[0][0] - before, 100 * dt * a, 1e-10 * before);
}

TEST(StaticKineticLaw, BetweenTheAnglesABlockStaysAtRestOrGoesOn)
{
  const double angle = std::atan(0.5 * mu_k * (1. + ratio)), dt = 1e-4;
  Block        at_rest(angle), pushed(angle, 10. * v_0), nudged(angle, 0.1 * v_0);
  at_rest.step(dt, 100);
  EXPECT_NEAR(at_rest.grains.velocity[0][0], 0., 1e-15);
  nudged.step(dt, 100);
  EXPECT_NEAR(nudged.grains.velocity[0][0], 0., 1e-15);
  double v = 10. * v_0;
  for (int s = 0; s < 100; ++s)
    {
      v += dt * g * (std::sin(angle) - mu(v) * std::cos(angle));
      pushed.step(dt);
      ASSERT_NEAR(pushed.grains.velocity[0][0], v, 1e-11 * v);
    }
  EXPECT_GT(v, 12. * v_0);
}

TEST(StaticKineticLaw, BeltsCount)
{
  for (const double belt : {0.3 * v_0, 3. * v_0})
    {
      Block        s(0., 0., belt);
      const double dt = 1e-5; // too short to catch up with the belt
      s.step(dt);
      EXPECT_NEAR(s.grains.velocity[0][0], dt * mu(belt) * g, 1e-12 * v_0);
    }
}

TEST(StaticKineticLaw, SpinCounts)
{
  for (const double spin : {0.5 * v_0, -5. * v_0})
    {
      Scene s;
      s.set(law + "set Residual tolerance = 1e-13\nset Largest violation = 1e-13\nset Steps to rest = 0\n");
      s.add(0., 0.);
      s.add(0., d);
      s.grains.mass[0]  = std::numeric_limits<double>::infinity();
      s.grains.omega[1] = spin / r;
      const double dt = 1e-6, m = s.grains.mass[1];
      s.loads.force[0] = {0., 0.};
      s.loads.force[1] = {0., -m * g};
      s.loads.drag.assign(2, 0.);
      s.stepper.advance(s.grains, s.loads, dt, {{0., -g}});
      EXPECT_NEAR(s.grains.contact_force[1][1], m * g, 1e-10 * m * g);
      EXPECT_NEAR(std::abs(s.grains.contact_force[0][1]), mu(spin) * m * g, 1e-10 * m * g);
      EXPECT_NEAR(s.grains.omega[1] * r, spin - std::copysign(2. * dt * mu(spin) * g, spin), 1e-10 * v_0);
    }
}

TEST(StaticKineticLaw, WithoutAStepItIsCoulombs)
{
  // The same bits, also where impacts bounce and grains resist rolling.
  const std::string common =
    "set Friction coefficient = 0.3\nset Wall friction coefficient = 0.2\nset Restitution = 0.5\n"
    "set Rolling friction coefficient = 0.02\n";
  Scene coulomb, other;
  coulomb.set(common);
  other.set(common + "set Contact law = static-kinetic\nsubsection Contact law: static-kinetic\n"
                     " set Static friction ratio = 1\nend\n");
  for (Scene *s : {&coulomb, &other})
    {
      s->floor();
      for (int k = 0; k < 30; ++k)
        s->add(1.1 * d * (k % 6) + 0.1 * d * (k / 6), d * (0.6 + 1.2 * (k / 6)), 0.1 * std::sin(k));
      s->step(2e-4, 200);
    }
  EXPECT_GT(coulomb.report.n_contacts, 20u);
  EXPECT_EQ(coulomb.grains.position[0], other.grains.position[0]);
  EXPECT_EQ(coulomb.grains.velocity[1], other.grains.velocity[1]);
  EXPECT_EQ(coulomb.grains.omega, other.grains.omega);
}

TEST(StaticKineticLaw, SoftSpheresRefuseIt)
{
  Scene s;
  EXPECT_THROW(s.set(law + "set Contact model = soft-sphere\n"), UserError);
}
