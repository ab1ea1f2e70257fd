// Soft spheres against exact answers.
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include "contact_scene.h"

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  std::string soft(const double stiffness, const double restitution, const std::string &more = "")
  {
    return "set Contact model = soft-sphere\n" + more +
           "subsection Soft spheres\n set Stiffness = " + std::to_string(stiffness) +
           "\n set Restitution = " + std::to_string(restitution) + "\nend";
  }
} // namespace

// Head on and against a wall, the speed after is e times the speed before.
TEST(SoftSpheres, Restitution)
{
  for (const double e : {0.3, 0.8, 1.})
    {
      Scene s;
      s.set(soft(1e5, e) + "\nsubsection Soft spheres\n set Steps per collision = 1000\nend");
      s.gy = 0.;
      s.stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}});
      s.add(0., 0.7 * d, 0., -0.1);
      s.add(0., 10. * d, 0.1);
      s.add(1.5 * d, 10. * d, -0.1, 0., 0.5 * r);
      const double m1 = s.grains.mass[1], m2 = s.grains.mass[2], momentum = 0.1 * (m1 - m2);
      s.step(1e-4, 100);
      EXPECT_NEAR(s.grains.velocity[1][0], 0.1 * e, 3e-3 * 0.1) << e;
      EXPECT_NEAR(s.grains.velocity[0][2] - s.grains.velocity[0][1], 0.2 * e, 3e-3 * 0.2) << e;
      EXPECT_NEAR(m1 * s.grains.velocity[0][1] + m2 * s.grains.velocity[0][2], momentum, 1e-12 * m1);
    }
}

// With e = 1 nothing is lost: what kinetic energy and height lack is in the springs, also seen from a restart.
TEST(SoftSpheres, SpringsHoldTheRest)
{
  Scene s;
  s.set(soft(1e3, 1.) + "\nset Wall friction coefficient = 0.5\nset Friction coefficient = 0.5\n"
                        "subsection Soft spheres\n set Steps per collision = 1000\nend");
  s.floor();
  s.add(0., 1.2 * r, 0.05, -0.1);
  s.add(0.1 * d, 2. * d, 0., -0.2);
  const auto energy = [&] {
    double sum = 0.;
    for (std::size_t k = 0; k < s.grains.n(); ++k)
      {
        const double v2 = std::pow(s.grains.velocity[0][k], 2) + std::pow(s.grains.velocity[1][k], 2);
        sum += s.grains.mass[k] * (0.5 * v2 + g * s.grains.position[1][k]) +
               0.5 * disc_inertia(s.grains.mass[k], s.grains.radius[k]) * std::pow(s.grains.omega[k], 2);
      }
    return sum;
  };
  const double all     = energy();
  double       largest = 0.;
  s.step(1e-5, 1);
  for (unsigned int n = 0; n < 300; ++n)
    {
      s.step(2e-5, 1);
      largest = std::max(largest, s.report.spring_energy);
      // what slips is lost
      EXPECT_LE(energy() + s.report.spring_energy, all * (1. + 1e-4)) << n;
      ContactStepper           again;
      dealii::ParameterHandler prm;
      again.add_parameters(prm);
      prm.parse_input_from_string(soft(1e3, 1.));
      again.set_walls(s.stepper.walls());
      again.set_archive(s.stepper.archive());
      EXPECT_NEAR(again.spring_energy(s.grains), s.report.spring_energy, 1e-14 * all);
      EXPECT_NEAR(s.stepper.spring_energy(s.grains), s.report.spring_energy, 1e-14 * all);
    }
  EXPECT_GT(largest, 0.2 * all);
  Scene frictionless;
  frictionless.set(soft(1e3, 1.) + "\nset Wall friction coefficient = 0\nset Friction coefficient = 0\n"
                                   "subsection Soft spheres\n set Steps per collision = 1000\nend");
  frictionless.grains = s.grains;
  frictionless.floor();
  frictionless.grains.omega.assign(2, 0.);
  frictionless.grains.position[1] = {3. * r, 3. * d};
  s.grains                        = frictionless.grains;
  const double start              = energy();
  for (unsigned int n = 0; n < 300; ++n)
    {
      frictionless.step(1e-4, 1);
      s.grains = frictionless.grains;
      EXPECT_NEAR(energy() + frictionless.report.spring_energy, start, 2e-4 * start) << n;
    }
}

// The overlap at the foot of a stack is n m g / k, and the floor carries the weight.
TEST(SoftSpheres, Stack)
{
  const int n = 5;
  Scene     s;
  s.set(soft(1e5, 0.3));
  s.floor();
  for (int k = 0; k < n; ++k)
    s.add(0., r + k * d);
  s.step(1e-3, 400);
  const double mg = s.grains.mass[0] * g;
  EXPECT_NEAR(s.report.wall_force["floor"][1] / (-n * mg), 1., 1e-6);
  EXPECT_NEAR((r - s.grains.position[1][0]) / (n * mg / 1e5), 1., 1e-6);
  EXPECT_NEAR(s.report.max_penetration / (n * mg / 1e5), 1., 1e-6);
  for (int k = 0; k < n; ++k)
    EXPECT_NEAR(s.grains.contact_force[1][k] / mg, 1., 1e-6);
  EXPECT_EQ(s.report.n_contacts, static_cast<unsigned int>(n));
}

// 2/3 g sin a while it rolls, g (sin a - mu cos a) when it slips.
TEST(SoftSpheres, DiscOnIncline)
{
  for (const double degrees : {20., 60.})
    {
      Scene        s;
      const double a = degrees * M_PI / 180., mu = 0.4;
      s.set(soft(1e6, 0.2));
      s.gx = g * std::sin(a);
      s.gy = -g * std::cos(a);
      s.floor();
      s.add(0., r);
      s.step(1e-3, 20); // let it settle on its spring
      const double before = s.grains.velocity[0][0];
      s.step(1e-3, 50);
      const bool   rolls    = std::tan(a) < 3. * mu;
      const double expected = (rolls ? 2. / 3. * std::sin(a) : std::sin(a) - mu * std::cos(a)) * g * 5e-2;
      EXPECT_NEAR((s.grains.velocity[0][0] - before) / expected, 1., 2e-3) << degrees;
    }
}

// A block below the angle of friction hangs on its tangential spring, also over a restart.
TEST(SoftSpheres, SpringsSurviveARestart)
{
  double     springs[2];
  const auto run = [&](const bool restart) {
    Scene first, second;
    for (Scene *s : {&first, &second})
      {
        s->set(soft(1e5, 0.3, "set Grains rotate = false\n"));
        s->gx = 0.3 * g;
        s->floor();
      }
    first.add(0., r);
    first.step(1e-3, 100);
    Scene &s = restart ? second : first;
    if (restart)
      {
        second.grains = first.grains;
        second.stepper.set_archive(first.stepper.archive());
      }
    s.step(1e-3, 100);
    springs[restart] = s.stepper.archive().entries.at(0).rt;
    return s.grains;
  };
  const GrainArrays whole = run(false), restarted = run(true);
  EXPECT_EQ(whole.position[0][0], restarted.position[0][0]);
  EXPECT_EQ(whole.velocity[0][0], restarted.velocity[0][0]);
  EXPECT_LT(std::abs(whole.velocity[0][0]), 1e-9);
  EXPECT_EQ(springs[0], springs[1]);
  EXPECT_NEAR(std::abs(springs[0]) * 2. / 7. * 1e5 / (0.3 * whole.mass[0] * g), 1., 1e-5);
}

TEST(SoftSpheres, DragIsImplicit)
{
  Scene s;
  s.set(soft(1e5, 0.5));
  s.add(0., d, 0., 0.);
  s.loads.drag = {100. * s.grains.mass[0]};
  s.step(1e-3, 200);
  EXPECT_NEAR(s.grains.velocity[1][0] / (-g / 100.), 1., 1e-6); // its terminal velocity
}

TEST(SoftSpheres, UnknownLawsAreRefused)
{
  Scene s;
  s.set(soft(1e5, 0.5, "set Rolling friction coefficient = 0.1\n"));
  s.add(0., 0.);
  EXPECT_THROW(s.step(1e-4), UserError);
}
