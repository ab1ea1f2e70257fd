// What contact solvers are made of: sums that do not depend on their order, colours, and how they agree.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/hydrostatic_guess.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/reproducible_sum.h>

#include "heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::contacts::test;
using namespace alluvium::grains;

namespace
{
  /** Solve @p heap on several ranks, dealt out by @p owner; velocities of all discs. */
  std::vector<Disc> solve_on_ranks(const Heap                   &heap,
                                   const int                     n_ranks,
                                   const std::vector<int>       &owner,
                                   const std::string            &solver,
                                   const bool                    cold,
                                   std::vector<ContactSolution> &solutions)
  {
    solutions.resize(n_ranks);
    return on_ranks(heap, n_ranks, owner, [&](Heap &part, const int rank) {
      ContactTolerance tolerance;
      tolerance.stagnation_factor = 1.;
      tolerance.residual          = 1e-4;
      tolerance.max_sweeps        = 400;
      const auto plugin           = make_solver(solver);
      solutions[rank] =
        cold ? solve_from_hydrostatic_guess(part.problem, part.places(), {{{0., -1.}}, part.weight}, *plugin, tolerance)
             : plugin->solve(part.problem, tolerance);
    });
  }
} // namespace

TEST(ReproducibleSum, DoesNotDependOnTheOrder)
{
  std::mt19937_64     random(3);
  std::vector<double> terms(10000);
  double              plain = 0., bound = 0.;
  for (double &t : terms)
    {
      t = std::exp(-30. * (random() >> 11) * 0x1p-53) * ((random() & 1) ? 1. : -1.);
      bound += std::abs(t);
    }
  std::vector<double> totals, plain_totals;
  for (int order = 0; order < 20; ++order)
    {
      std::shuffle(terms.begin(), terms.end(), random);
      ReproducibleSum sum(bound);
      plain = 0.;
      for (const double t : terms)
        {
          sum.add(t);
          plain += t;
        }
      totals.push_back(sum.value());
      plain_totals.push_back(plain);
    }
  EXPECT_EQ(std::count(totals.begin(), totals.end(), totals[0]), 20);
  EXPECT_LT(std::count(plain_totals.begin(), plain_totals.end(), plain_totals[0]), 20); // or the test shows nothing
  EXPECT_NEAR(totals[0], plain, 1e4 * 0x1p-50 * bound);
}

// Sums of sums, as over ranks, are the sum; also when the parts are cut elsewhere.
TEST(ReproducibleSum, PartsAddUp)
{
  std::mt19937_64     random(5);
  std::vector<double> terms(1000);
  for (double &t : terms)
    t = std::exp(-10. * (random() >> 11) * 0x1p-53);
  ReproducibleSum whole(1000.);
  for (const double t : terms)
    whole.add(t);
  for (const std::size_t cut : {1, 77, 500, 999})
    {
      ReproducibleSum a(1000.), b(1000.);
      for (std::size_t k = 0; k < terms.size(); ++k)
        (k < cut ? a : b).add(terms[k]);
      EXPECT_EQ(a.value() + b.value(), whole.value());
    }
}

// Whether a sum of positive terms outgrew its bound is known, in any order.
TEST(ReproducibleSum, KnowsWhenTheBoundWasTooSmall)
{
  std::vector<double> terms(100, 1.);
  terms[0] = 1e-9;
  terms[1] = 40.;
  for (int order = 0; order < 100; ++order)
    {
      std::rotate(terms.begin(), terms.begin() + 1, terms.end());
      ReproducibleSum small(100.), large(200.);
      for (const double t : terms)
        {
          small.add(t);
          large.add(t);
        }
      EXPECT_FALSE(small.holds());
      EXPECT_TRUE(large.holds());
    }
  ReproducibleSum sum(1.);
  sum.add(std::nan(""));
  EXPECT_FALSE(sum.holds());
}

// Every solver finds the same: the walls carry the weight, and nothing moves.
TEST(Solvers, AllCarryTheWeight)
{
  for (const auto &[name, entry] : Registry<ContactSolver>::entries())
    {
      Heap             heap(6, 8);
      ContactTolerance tolerance;
      tolerance.residual             = 1e-9;
      tolerance.stagnation_factor    = 1.;
      tolerance.max_sweeps           = 20000;
      const ContactSolution solution = make_solver(name)->solve(heap.problem, tolerance);
      EXPECT_TRUE(solution.converged) << name << ' ' << solution.residual;
      EXPECT_NEAR(heap.floor_support(), 1., 1e-6) << name;
      for (std::size_t k = 0; k < heap.x.size(); ++k)
        ASSERT_LT(std::hypot(heap.problem.discs[k].x, heap.problem.discs[k].y), 1e-6 * 9.81e-4) << name;
    }
}

TEST(Solvers, OrdersOfGaussSeidelAgree)
{
  for (const std::string order : {"colour", "file", "gravity"})
    {
      Heap             heap(4, 6);
      ContactTolerance tolerance;
      tolerance.residual          = 1e-8;
      tolerance.stagnation_factor = 1.;
      tolerance.max_sweeps        = 20000;
      const auto solution         = make_solver("Gauss-Seidel", "set Order = " + order)->solve(heap.problem, tolerance);
      EXPECT_TRUE(solution.converged) << order;
      EXPECT_NEAR(heap.floor_support(), 1., 1e-5) << order;
    }
}

// One that cannot run on several ranks says so.
TEST(Solvers, RefuseSeveralRanks)
{
  Heap       heap(2, 2);
  Team       team(1, heap.x.size());
  TeamMember member(team, {0, 1, 2, 3}, 4);
  heap.problem.communicator = &member;
  EXPECT_THROW(make_solver("work queue")->solve(heap.problem, {}), UserError);
  EXPECT_THROW(make_solver("Gauss-Seidel", "set Order = file")->solve(heap.problem, {}), UserError);
  EXPECT_NO_THROW(make_solver("Gauss-Seidel")->solve(heap.problem, {}));
}

// The same bits on any number of ranks, however the discs are dealt out.
TEST(Solvers, SameBitsOnAnyNumberOfRanks)
{
  const Heap heap(8, 6);
  for (const bool cold : {false, true})
    for (const std::string solver : {"Gauss-Seidel", "accelerated Gauss-Seidel", "SOR", "accelerated Jacobi"})
      {
        std::vector<ContactSolution> first_solutions, solutions;
        const std::vector<Disc>      first =
          solve_on_ranks(heap, 1, std::vector<int>(heap.x.size(), 0), solver, cold, first_solutions);
        for (const int n_ranks : {2, 3})
          {
            std::vector<int> owner(heap.x.size());
            for (std::size_t k = 0; k < owner.size(); ++k)
              owner[k] = n_ranks == 2 ? (heap.x[k] > 3.3e-3) : static_cast<int>((7 * k + k / 5) % 3);
            const std::vector<Disc> other = solve_on_ranks(heap, n_ranks, owner, solver, cold, solutions);
            for (const ContactSolution &s : solutions)
              {
                EXPECT_EQ(s.sweeps, first_solutions[0].sweeps) << solver;
                EXPECT_EQ(s.residual, first_solutions[0].residual) << solver;
                EXPECT_EQ(s.violation, first_solutions[0].violation) << solver;
              }
            for (std::size_t k = 0; k < first.size(); ++k)
              {
                ASSERT_EQ(first[k].x, other[k].x) << solver << ' ' << n_ranks << ' ' << cold;
                ASSERT_EQ(first[k].y, other[k].y) << solver;
                ASSERT_EQ(first[k].s, other[k].s) << solver;
              }
          }
      }
}

// From nothing, weight comes down by about a layer a sweep; a cold start has it there at once.
TEST(Solvers, ColdStart)
{
  ContactTolerance tolerance;
  tolerance.stagnation_factor = 1.;
  tolerance.residual          = 1e-7;
  tolerance.max_sweeps        = 60;
  const auto solver           = make_solver("accelerated Gauss-Seidel");
  Heap       plain(40, 60), cold(40, 60);
  solver->solve(plain.problem, tolerance);
  solve_from_hydrostatic_guess(cold.problem, cold.places(), {{{0., -1.}}, cold.weight}, *solver, tolerance);
  EXPECT_LT(plain.floor_support(), 0.6);
  EXPECT_GT(cold.floor_support(), 0.9);
  EXPECT_LT(cold.floor_support(), 1.1);
  for (const Contact &c : cold.problem.contacts)
    ASSERT_LE(std::abs(c.rt), c.friction * c.rn * (1. + 1e-12));
}

// The solver that the work queue falls back on has the parameters that its own section sets.
TEST(Solvers, FallbackOfTheWorkQueueHasItsParameters)
{
  const auto sweeps = [](const std::string &name, const std::string &fallback_parameter) {
    PluginChoice<ContactSolver> choice;
    dealii::ParameterHandler    prm;
    choice.add_parameters(prm, "Contact solver", "work queue", "");
    prm.parse_input_from_string(
      "set Contact solver = " + name + "\nsubsection Contact solver: work queue\nset Largest queue = 0\nend\n" +
      "subsection Contact solver: accelerated Gauss-Seidel\nset " + fallback_parameter + "\nend\n");
    Heap             heap(8, 20);
    ContactTolerance tolerance;
    tolerance.stagnation_factor    = 1.;
    const ContactSolution solution = choice.get().solve(heap.problem, tolerance);
    EXPECT_TRUE(solution.converged);
    return solution.sweeps;
  };
  for (const std::string parameter : {"Largest momentum = 0.5", "Largest momentum = 0.95"})
    EXPECT_NEAR(sweeps("work queue", parameter) / (1. + sweeps("accelerated Gauss-Seidel", parameter)), 1., 0.05)
      << parameter;
  EXPECT_GT(sweeps("work queue", "Largest momentum = 0.5"), 2 * sweeps("work queue", "Largest momentum = 0.95"));
}
