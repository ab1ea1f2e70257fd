// Added mass: the acceleration of a lone grain in closed form, whatever the sub-steps; the third law; and what cannot
// have it.
#include "bed.h"

#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

namespace
{
  using namespace dealii;
  constexpr double rho = 1000., rho_p = 2630., g = 9.81, dt = 1e-3, r = 1e-3;

  /** Acceleration in the first step of a lone grain from rest, over what it is without a fluid's response. */
  double acceleration(const double c_m, const double fluid_acceleration, const bool gravity, const bool soft)
  {
    bed::Channel             channel(8. * r, 8. * r, r, {}, 0.);
    bed::grains::GrainArrays grains;
    grains.resize(1);
    grains.position[0][0] = 4.1 * r;
    grains.position[1][0] = 3.7 * r;
    grains.radius[0] = grains.fluid_radius[0] = r;
    grains.mass[0]                            = rho_p * numbers::PI * r * r;
    bed::coupling::OverlapMap map(channel.space);
    map.reinit();
    map.cut(grains, {});
    // one-way: the fluid's fields are given; Euler's equation is its pressure gradient
    bed::coupling::PieceState pieces;
    pieces.dt      = dt;
    pieces.touched = {0};
    bed::coupling::CouplingState state(grains, map, std::move(pieces));
    const std::size_t            n = state.n_pieces();
    state.gravity                  = {{0., gravity ? -g : 0.}};
    state.fluid_density            = rho;
    state.gamma.assign(n, 1e-30);
    state.old.assign(n, {{{0., 0.}}, {{0., 0.}}});
    state.latest.assign(n, {{{0., dt * fluid_acceleration}}, {{0., -rho * fluid_acceleration}}});
    state.added_density = c_m * rho;
    state.acceleration.assign(n, {{0., 0.}});
    const auto scheme = alluvium::Registry<bed::coupling::TimeScheme>::entries().at("semi-implicit per grain").create();
    bed::grains::GrainLoads loads;
    loads.reset(1);
    bed::coupling::GrainSums sums(1, scheme->n_load_sums());
    scheme->add_load_sums(state, sums, 0);
    scheme->loads(state, {{{0., 0.}}}, sums, 0, loads);

    alluvium::contacts::ContactStepper stepper;
    ParameterHandler                   prm;
    stepper.add_parameters(prm);
    if (soft)
      prm.set("Contact model", "soft-sphere");
    stepper.advance(grains, loads, dt, state.gravity);
    EXPECT_NEAR(grains.velocity[0][0], 0., 1e-15);
    return grains.velocity[1][0] / dt;
  }
} // namespace

TEST(AddedMass, LoneGrainReleased)
{
  for (const bool soft : {false, true})
    for (const double c_m : {0., 0.5, 1.})
      EXPECT_NEAR(acceleration(c_m, 0., true, soft) / (-(rho_p - rho) * g / (rho_p + c_m * rho)), 1., 1e-12)
        << "C_m " << c_m << " soft spheres " << soft;
}

TEST(AddedMass, LoneGrainInAcceleratedFluid)
{
  for (const double c_m : {0., 0.5, 1.})
    EXPECT_NEAR(acceleration(c_m, 2.5, false, false) / (2.5 * (1. + c_m) * rho / (rho_p + c_m * rho)), 1., 1e-12)
      << "C_m " << c_m;
}

TEST(AddedMass, ThirdLaw)
{
  bed::Bed b = bed::random_bed(3, 16., 12.);
  for (std::size_t i = 0; i < b.grains.n(); ++i)
    {
      b.grains.velocity[0][i] = 1e-3 * std::sin(7. * i);
      b.grains.velocity[1][i] = 1e-3 * std::cos(5. * i);
    }
  for (const std::string scheme : {"semi-implicit per piece", "semi-implicit per grain"})
    {
      bed::Settings s;
      s.scheme     = scheme;
      s.dt         = 1e-5;
      s.added_mass = 1.;
      bed::Channel channel(b.width, b.height, b.d, s, 100.);
      for (unsigned int k = 0; k < 3; ++k)
        channel.step(b.grains, false);
      channel.coupling.audit();
      const auto &report = channel.coupling.report();
      for (unsigned int d = 0; d < 2; ++d)
        EXPECT_LT(std::abs(report.force_on_grains[d] + report.force_on_fluid[d]), 1e-12 * report.force_scale) << scheme;
    }
}

TEST(AddedMass, NeedsAPrediction)
{
  bed::Settings s;
  s.added_mass = 0.5;
  for (const std::string scheme : {"explicit", "implicit drag"})
    {
      s.scheme = scheme;
      EXPECT_THROW(bed::Channel(1., 1., 0.5, s, 0.), alluvium::UserError) << scheme;
    }
}
