// Steps repeated with the new contact forces: exact where the problem is linear, and a jammed bed that does not
// notice the time step.
#include "free_bed.h"

#include <alluvium/utilities/anderson_mixing.h>

#include <gtest/gtest.h>

#include <numeric>

namespace
{
  using alluvium::AndersonMixing;
  using namespace bed;

  TEST(AndersonMixing, SolvesALinearFixedPoint)
  {
    // x <- A x + b, eigenvalues of A up to -3: plain repetition runs away
    const double a[3][3] = {{-3., 0.4, 0.}, {0.1, 0.9, 0.2}, {0., -0.3, 0.5}}, b[3] = {1., -2., 3.};
    const auto   map = [&](const std::vector<double> &x) {
      std::vector<double> y(3);
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = b[i] + a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2];
      return y;
    };
    AndersonMixing                   mixing(4);
    std::vector<std::vector<double>> answers;
    std::vector<double>              x(3, 0.), residual(3);
    for (unsigned int k = 0; k < 5; ++k)
      {
        answers.push_back(map(x));
        for (unsigned int i = 0; i < 3; ++i)
          residual[i] = answers.back()[i] - x[i];
        mixing.add(residual);
        if (answers.size() > mixing.n())
          answers.erase(answers.begin());
        const std::vector<double> w = mixing.weights();
        EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.), 1., 1e-10);
        x.assign(3, 0.);
        for (std::size_t k = 0; k < w.size(); ++k)
          for (unsigned int i = 0; i < 3; ++i)
            x[i] += w[k] * answers[k][i];
      }
    const std::vector<double> y = map(x);
    for (unsigned int i = 0; i < 3; ++i)
      EXPECT_NEAR(y[i], x[i], 1e-12);
  }


  /** tau_p of the bed, about [s]. */
  constexpr double tau = 1.1e-3;

  struct Transient
  {
    std::vector<double> flux, error; // over the fixed bed's flux and velocity
    unsigned int        n_repetitions = 0;
  };

  Transient head_jump(const std::string &scheme, const double dt, const unsigned int n_established)
  {
    Settings s;
    s.scheme = scheme;
    s.dt     = dt;
    FreeBed   free(s, {}), fixed(s, {});
    Transient result;
    free.set_head(0.);
    fixed.set_head(0.);
    for (unsigned int k = 0; k < 12; ++k) // until contacts know the weight
      free.step();
    for (unsigned int k = 0; k < n_established + 6; ++k)
      {
        const double head = k < n_established ? 0.25 : 0.5;
        free.set_head(head);
        fixed.set_head(head);
        fixed.step(true);
        free.step();
        if (k < n_established)
          continue;
        result.flux.push_back(free.flux() / fixed.flux());
        result.error.push_back(free.prediction_error() * free.width / fixed.flux());
        result.n_repetitions += free.coupled_step.iteration().n_iterations();
        EXPECT_TRUE(free.coupled_step.iteration().agrees());
      }
    return result;
  }

  TEST(Iterated, JammedBedHasTheFixedBedsFluxAtOnce)
  {
    for (const double dt : {tau, 13. * tau})
      for (const unsigned int n_established : {0u, 12u})
        {
          const Transient r = head_jump("iterated", dt, n_established);
          for (std::size_t k = 0; k < r.flux.size(); ++k)
            {
              EXPECT_NEAR(r.flux[k], 1., 0.01) << "dt " << dt << " step " << k + 1;
              EXPECT_LT(r.error[k], 0.01) << "dt " << dt << " step " << k + 1;
            }
          EXPECT_LE(r.n_repetitions, 20u);
        }
    // what it is good for
    const Transient lagged = head_jump("semi-implicit per grain", 13. * tau, 0);
    EXPECT_GT(std::abs(lagged.flux[0] - 1.), 0.5);
    EXPECT_GT(std::abs(lagged.flux[5] - 1.), 0.05);
  }

  TEST(Iterated, FluidReceivesWhatTheGrainsGot)
  {
    Settings s;
    s.scheme      = "iterated";
    s.dt          = 13. * tau;
    s.tolerance   = 1e-8;
    s.repetitions = 200;
    FreeBedSettings f;
    f.residual_tolerance = 1e-10;
    f.n                  = 60;
    FreeBed bed(s, f);
    bed.set_head(0.);
    for (unsigned int k = 0; k < 12; ++k)
      bed.step();
    bed.set_head(0.6);
    const auto before = bed.grains;
    bed.step();
    EXPECT_GT(bed.coupled_step.iteration().n_iterations(), 0u);
    EXPECT_TRUE(bed.coupled_step.iteration().agrees());
    const auto &r = bed.channel.coupling.report();
    EXPECT_LT(std::hypot(r.momentum_defect[0], r.momentum_defect[1]), 1e-8 * r.force_scale);
    // grain by grain: m (v - v^n)/dt = submerged weight + force that the fluid received + contacts
    for (std::size_t k = 0; k < bed.grains.n(); ++k)
      {
        const double volume = numbers::PI * before.fluid_radius[k] * before.fluid_radius[k];
        const double weight = FreeBed::g * before.mass[k], reduced = weight - FreeBed::g * 1000. * volume;
        const auto  &force = bed.channel.coupling.fluid_force()[k];
        EXPECT_NEAR(before.mass[k] * (bed.grains.velocity[0][k] - before.velocity[0][k]) / s.dt,
                    force[0] + bed.grains.contact_force[0][k],
                    1e-6 * weight);
        EXPECT_NEAR(before.mass[k] * (bed.grains.velocity[1][k] - before.velocity[1][k]) / s.dt,
                    force[1] + bed.grains.contact_force[1][k] - reduced,
                    1e-6 * weight);
      }
  }

  /** Momentum that the fluid did not receive while a bed is lifted from rest, over all that was exchanged. */
  double momentum_not_received(const std::string &scheme)
  {
    Settings s;
    s.scheme = scheme;
    s.dt     = tau;
    FreeBed bed(s, {});
    bed.set_head(1.2);
    std::array<double, 2> missing  = {{0., 0.}};
    double                received = 0.;
    for (unsigned int k = 0; k < 20; ++k)
      {
        bed.step();
        const auto &r = bed.channel.coupling.report();
        for (unsigned int d = 0; d < 2; ++d)
          missing[d] += r.momentum_defect[d];
        received += r.force_scale;
      }
    return std::hypot(missing[0], missing[1]) / received;
  }

  TEST(Iterated, LiftedBedsMomentumArrives)
  {
    EXPECT_LT(momentum_not_received("iterated"), 1e-3);
    EXPECT_GT(momentum_not_received("semi-implicit per grain"), 1e-2);
  }

  // Whether a step agrees is said of what is kept, not of the loose solve of contacts before it.
  TEST(Iterated, AgreementIsThatOfTheTightSolve)
  {
    Settings s;
    s.scheme    = "iterated";
    s.dt        = tau;
    s.tolerance = 1e-2;
    FreeBedSettings f;
    f.n = 120;
    FreeBed bed(s, f);
    bed.set_head(1.5);
    unsigned int n_tight = 0;
    for (unsigned int k = 0; k < 40; ++k)
      {
        const auto before = bed.grains;
        bed.step();
        n_tight += bed.report.was_loosened ? 0 : bed.coupled_step.iteration().n_iterations() > 0;
        coupling::GrainMotion motion{bed.grains.velocity, bed.grains.omega};
        for (unsigned int d = 0; d < 2; ++d)
          for (std::size_t g = 0; g < before.n(); ++g)
            motion.velocity[d][g] = (bed.grains.position[d][g] - before.position[d][g]) / s.dt;
        const auto           &c      = bed.channel.coupling;
        const auto            defect = c.momentum_defect(bed.grains, before.velocity, motion, bed.channel.loads);
        std::array<double, 2> sum    = {{0., 0.}};
        double                square = 0.;
        for (std::size_t i = 0; i < defect.size(); ++i)
          {
            sum[i % 2] += defect[i];
            square += defect[i] * defect[i];
          }
        const double tolerance = bed.coupled_step.iteration().n_iterations() == 0 ? 0.1 * s.tolerance : s.tolerance;
        const double ratio =
          std::max(std::sqrt(2. * square / defect.size()) / (tolerance * c.typical_force(bed.grains)),
                   std::hypot(sum[0], sum[1]) / (0.1 * tolerance * c.report().force_scale));
        if (std::abs(ratio - 1.) > 1e-6)
          {
            EXPECT_EQ(bed.coupled_step.iteration().agrees(), ratio < 1.) << "step " << k << ": " << ratio << " of the tolerance";
          }
      }
    EXPECT_GT(n_tight, 0u);
  }

  /** Largest distance between the velocity of a piece, as the fluid saw it, and that of its grain [m/s]. */
  double largest_deviation(const FreeBed &bed, const grains::GrainArrays &before)
  {
    const auto &map     = bed.channel.coupling.overlap();
    const auto  v       = bed.channel.coupling.piece_velocities();
    double      largest = 0.;
    for (std::size_t k = 0; k < v.size(); ++k)
      {
        const unsigned int g = map.grain()[k];
        largest =
          std::max(largest,
                   std::hypot(v[k][0] - (bed.grains.position[0][g] - before.position[0][g]) / bed.channel.settings.dt,
                              v[k][1] - (bed.grains.position[1][g] - before.position[1][g]) / bed.channel.settings.dt));
      }
    return largest;
  }

  struct Lift
  {
    double deviation = 0., rise_exact = 0., difference = 0.; // over the fluid's velocity; [d]; over the rise
  };

  /** Lift a bed by three times the head that it takes, with two sweeps a step and with the exact rigid coupling. */
  Lift lift(Settings s, const double density, const unsigned int n_steps)
  {
    FreeBedSettings f;
    f.n                  = 60;
    f.density            = density;
    f.residual_tolerance = 1e-10;
    f.is_strict          = true; // or the answers are not those of one tolerance
    s.h_over_d           = 2.;
    s.scheme             = "semi-implicit per grain";
    FreeBed two_sweeps(s, f);
    s.scheme      = "iterated";
    s.tolerance   = 1e-9;
    s.repetitions = 200;
    FreeBed exact(s, f);
    Lift    result;
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        const auto before = exact.grains;
        for (FreeBed *bed : {&two_sweeps, &exact})
          {
            bed->channel.solver.linear_solver.tolerance = 1e-12;
            bed->set_head(3.);
            bed->step();
          }
        EXPECT_TRUE(exact.coupled_step.iteration().agrees());
        result.deviation = std::max(result.deviation, largest_deviation(exact, before) * exact.width / exact.flux());
      }
    for (std::size_t g = 0; g < exact.grains.n(); ++g)
      {
        result.difference += two_sweeps.grains.position[1][g] - exact.grains.position[1][g];
        result.rise_exact += exact.grains.position[1][g] - exact.grains.initial_position[1][g];
      }
    result.difference /= result.rise_exact;
    result.rise_exact /= f.n * FreeBed::d;
    return result;
  }

  /**
   * Repeated until nothing changes, the scheme is the exact rigid coupling: no piece moves otherwise than its grain.
   * Two sweeps a step tend to the same motion with the time step.
   */
  TEST(Iterated, ConvergesToTheRigidCoupling)
  {
    for (const std::string mesh : {"uniform", "triangles", "hanging nodes"})
      for (const double density : {2630., 1050.})
        {
          Settings s;
          s.triangles       = mesh == "triangles";
          s.graded          = mesh == "hanging nodes";
          s.dt              = 1e-3;
          const Lift coarse = lift(s, density, 6);
          s.dt              = 2e-4;
          const Lift fine   = lift(s, density, 30);
          EXPECT_LT(std::max(coarse.deviation, fine.deviation), 1e-6) << mesh << ", density " << density;
          EXPECT_GT(fine.rise_exact, 1e-3);
          EXPECT_LT(std::abs(fine.difference), 0.4 * std::abs(coarse.difference)) << mesh << ", density " << density;
        }
  }
} // namespace
