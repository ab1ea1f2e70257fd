// Conservation in the exchange: volumes, the third law for every scheme, rest and buoyancy, the drag laws' closed
// forms.
#include "bed.h"

#include <gtest/gtest.h>

using bed::Channel;
using bed::Settings;
using namespace dealii;

TEST(OverlapMap, PiecesAddUpToTheGrains)
{
  const bed::Bed b = bed::random_bed(2, 16., 12.);
  for (const bool triangles : {false, true})
    for (const double filter : {0., 2.})
      for (const double h : {4., 1., 0.4})
        {
          Settings s;
          s.filter    = filter;
          s.triangles = triangles;
          Channel channel(b.width, b.height, h * b.d, s, 0.);
          channel.coupling.update_void_fraction(b.grains);
          const auto         &map = channel.coupling.overlap();
          std::vector<double> area(b.grains.n(), 0.), moment_x(b.grains.n(), 0.);
          for (std::size_t k = 0; k < map.grain().size(); ++k)
            {
              area[map.grain()[k]] += map.terms().shape[k].area;
              double sum = 0.;
              for (const double phi : map.terms().shape[k].phi)
                sum += phi;
              ASSERT_NEAR(sum, 1., 1e-13);
            }
          for (std::size_t g = 0; g < b.grains.n(); ++g)
            EXPECT_NEAR(area[g] / (numbers::PI * b.grains.fluid_radius[g] * b.grains.fluid_radius[g]), 1., 1e-13);
          // the solid in the void fraction is all there
          double solid = 0., exact = 0.;
          for (unsigned int i = 0; i < channel.space.node_volumes().locally_owned_size(); ++i)
            solid +=
              channel.space.node_volumes().local_element(i) * (1. - channel.coupling.void_fraction().local_element(i));
          for (const double r : b.grains.fluid_radius)
            exact += numbers::PI * r * r;
          EXPECT_NEAR(solid / exact, 1., 1e-12) << "h/d " << h << " filter " << filter << " triangles " << triangles;
        }
}

TEST(OverlapMap, VoidFractionIsBoundedWithMoments)
{
  const bed::Bed b = bed::random_bed(2, 16., 12.);
  for (const double h : {2., 0.5, 0.25})
    {
      Settings s;
      s.filter = 0.;
      Channel channel(b.width, b.height, h * b.d, s, 0.);
      // the grains as they touch: the densest that can be
      bed::grains::GrainArrays g = b.grains;
      g.fluid_radius             = g.radius;
      channel.coupling.update_void_fraction(g);
      const auto &report = channel.coupling.report();
      // only grains cut by the rectangle's ends are pressed into it, whole
      EXPECT_GE(report.eps_min, 0.);
      EXPECT_LE(report.eps_max, 1.);
    }
}

TEST(OverlapMap, SingleGrainInsideNeedsNoClipping)
{
  // one disc over cells much finer than itself: full cells inside, exactly
  Settings s;
  s.filter = 0.;
  Channel                  channel(1., 1., 1. / 32., s, 0.);
  bed::grains::GrainArrays g;
  g.resize(1);
  g.position[0][0]  = 0.511;
  g.position[1][0]  = 0.487;
  g.radius[0]       = 0.25;
  g.fluid_radius[0] = 0.25;
  channel.coupling.update_void_fraction(g);
  EXPECT_NEAR(channel.coupling.report().eps_min, 0., 1e-13);
  EXPECT_NEAR(channel.coupling.report().clipped_volume, 0., 1e-15);
  EXPECT_DOUBLE_EQ(channel.coupling.report().eps_max, 1.);
}

TEST(Exchange, ThirdLaw)
{
  bed::Bed b = bed::random_bed(3, 16., 12.);
  for (std::size_t i = 0; i < b.grains.n(); ++i) // moving grains, pushed by their neighbours
    {
      b.grains.velocity[0][i]      = 1e-3 * std::sin(7. * i);
      b.grains.velocity[1][i]      = 1e-3 * std::cos(5. * i);
      b.grains.contact_force[1][i] = 9.81 * b.grains.mass[i] * (1. + std::sin(3. * i));
    }
  for (const std::string scheme : {"explicit", "implicit drag", "semi-implicit per piece", "semi-implicit per grain"})
    for (const bool lumped : {true, false})
      for (const bool triangles : {false, true})
        {
          Settings s;
          s.scheme    = scheme;
          s.dt        = 1e-5;
          s.lumped    = lumped;
          s.triangles = triangles;
          Channel channel(b.width, b.height, b.d, s, 100.);
          for (unsigned int k = 0; k < 3; ++k)
            channel.step(b.grains, false);
          channel.coupling.audit();
          const auto &r = channel.coupling.report();
          for (unsigned int d = 0; d < 2; ++d)
            EXPECT_LT(std::abs(r.force_on_grains[d] + r.force_on_fluid[d]), 1e-12 * r.force_scale)
              << scheme << " lumped " << lumped;
          EXPECT_GT(r.force_scale, 0.);
        }
}

TEST(Exchange, HydrostaticRest)
{
  const bed::Bed b = bed::random_bed(1, 16., 12.);
  for (const double h : {4., 1., 0.5})
    {
      Settings s;
      s.h_over_d              = h;
      const double rho_g      = 1000. * 9.81;
      const double overburden = 103e3;
      Channel      channel(b.width, b.height, h * b.d, s, overburden + rho_g * b.height);
      channel.bc.set(3,
                     {boundary_kinds::pressure, "top", std::make_shared<Functions::ConstantFunction<2>>(overburden)});
      channel.solver.gravity[1] = -9.81;
      channel.solver.choose_datum(channel.bc);
      for (unsigned int k = 0; k < 100; ++k)
        channel.step(b.grains, true);
      EXPECT_LE(channel.solver.solution().block(0).linfty_norm(), 1e-12) << "h/d " << h;
      // the total pressure's force is the reduced one plus rho g V
      double worst = 0.;
      for (std::size_t g = 0; g < b.grains.n(); ++g)
        {
          const double buoyancy = rho_g * numbers::PI * b.grains.fluid_radius[g] * b.grains.fluid_radius[g];
          worst                 = std::max(worst, std::abs(channel.coupling.fluid_force()[g][1]) / buoyancy);
        }
      EXPECT_LE(worst, 1e-10) << "h/d " << h;
    }
}

TEST(DragLaw, ClosedForms)
{
  using Registry   = alluvium::Registry<bed::coupling::DragLaw>;
  const double eps = 0.48, u = 0.02, d = 2.2e-4, rho = 1000., eta = 1e-3, re = rho * d * u / eta;
  // from the drag coefficient: F = C_D/2 rho S (eps u)^2 eps^-3.8 (with the voidage function), per volume and slip
  const double c_d = std::pow(0.63 + 4.8 / std::sqrt(eps * re), 2);
  const double sphere =
    0.5 * c_d * rho * (numbers::PI / 4. * d * d) * eps * eps * u * std::pow(eps, -3.8) / (numbers::PI / 6. * d * d * d);
  const double disc = 0.5 * c_d * rho * d * eps * eps * u * std::pow(eps, -3.8) / (numbers::PI / 4. * d * d);
  for (const auto &[name, exact] : {std::make_pair("sphere", sphere), std::make_pair("disc", disc)})
    {
      auto             law = Registry::entries().at(name).create();
      ParameterHandler prm;
      law->add_parameters(prm);
      EXPECT_NEAR(law->gamma({eps, u, d, rho, eta}) / exact, 1., 1e-12) << name;
      prm.set("Factor", 2.5);
      EXPECT_NEAR(law->gamma({eps, u, d, rho, eta}) / exact, 2.5, 1e-12) << name;
      prm.set("Exponent", "Di Felice");
      const double beta = 3.7 - 0.65 * std::exp(-0.5 * std::pow(1.5 - std::log10(eps * re), 2));
      EXPECT_NEAR(law->gamma({eps, u, d, rho, eta}) / (2.5 * exact * std::pow(eps, 3.8 - beta)), 1., 1e-12) << name;
    }
  auto             law = Registry::entries().at("paper").create();
  ParameterHandler prm;
  law->add_parameters(prm);
  EXPECT_NEAR(law->gamma({eps, u, d, rho, eta}),
              std::pow(eps, -2.8) * std::pow(0.77 * std::sqrt(eps * re) + 5.87, 2) * eta / (d * d),
              1e-6);
}
