// What contact solvers are made of: sums that do not depend on their order, colours, and how they agree.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/solvers/cold_start.h>
#include <alluvium/contacts/solvers/contact_measure.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::grains;

namespace
{
  /** A heap of discs of slightly different sizes on a floor between two walls, and its contacts. */
  struct Heap
  {
    std::vector<double> x, y, radius, weight;
    ContactProblem      problem;

    Heap(const int n_columns, const int n_rows)
    {
      constexpr double d = 1e-3, dt = 1e-4, g = 9.81;
      for (int row = 0; row < n_rows; ++row)
        for (int column = 0; column < n_columns; ++column)
          {
            x.push_back((column + 0.5 + 0.25 * (row % 2 == 0 ? -1 : 1)) * d + 1e-6 * std::sin(7. * row + 3. * column));
            y.push_back(0.5 * d + row * 0.5 * std::sqrt(3.) * d);
            radius.push_back(0.5 * d * (1. + 1e-3 * std::sin(5. * row + 11. * column)));
            weight.push_back(2500. * M_PI * radius.back() * radius.back() * g * dt);
          }
      const std::size_t n = x.size();
      problem.n_discs = problem.n_owned_discs = n;
      problem.discs.resize(n + 4);
      for (std::size_t k = 0; k < n; ++k)
        {
          problem.discs[k].y                = -g * dt;
          problem.discs[k].x                = 0.1 * g * dt * std::sin(1. * k);
          problem.discs[k].inverse_mass     = g * dt / weight[k];
          problem.discs[k].inverse_rotation = 2. * g * dt / weight[k];
        }
      problem.height        = y;
      problem.impulse_scale = weight[0];

      std::vector<std::vector<Contact>> colours;
      std::vector<std::uint64_t>        used(n, 0);
      const auto                        add = [&](const std::size_t i, const std::size_t j, Contact c) {
        c.i                       = i;
        c.j                       = j;
        c.friction                = 0.4;
        const std::uint64_t taken = used[i] | (j < n ? used[j] : 0);
        unsigned int        k     = 0;
        while ((taken >> k) & 1)
          ++k;
        used[i] |= std::uint64_t(1) << k;
        if (j < n)
          used[j] |= std::uint64_t(1) << k;
        colours.resize(std::max<std::size_t>(colours.size(), k + 1));
        colours[k].push_back(c);
      };
      const double width = (n_columns + 0.25) * d;
      for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t j = i + 1; j < n && y[j] < y[i] + 1.1 * d; ++j)
            if (const double distance = std::hypot(x[j] - x[i], y[j] - y[i]); distance < 1.02 * d)
              {
                Contact c{};
                c.nx     = (x[j] - x[i]) / distance;
                c.ny     = (y[j] - y[i]) / distance;
                c.bias_n = std::max(0., distance - radius[i] - radius[j] - 5e-6) / dt;
                add(i, j, c);
              }
          if (y[i] < 0.6 * d)
            {
              Contact c{};
              c.ny = -1.;
              add(i, n, c);
            }
          if (x[i] < 0.6 * d || x[i] > width - 0.8 * d)
            {
              Contact c{};
              c.nx = x[i] < 0.6 * d ? -1. : 1.;
              add(i, n + 1, c);
            }
        }
      problem.colour_begin = {0};
      for (const auto &colour : colours)
        {
          problem.contacts.insert(problem.contacts.end(), colour.begin(), colour.end());
          problem.colour_begin.push_back(problem.contacts.size());
        }
    }

    double floor_support() const
    {
      double carried = 0., sum = 0.;
      for (const Contact &c : problem.contacts)
        if (c.j >= problem.n_discs)
          carried -= c.rn * c.ny + c.rt * c.nx;
      for (const double w : weight)
        sum += w;
      return carried / sum;
    }
  };

  std::unique_ptr<ContactSolver> make_solver(const std::string &name, const std::string &parameters = "")
  {
    auto                     solver = Registry<ContactSolver>::entries().at(name).create();
    dealii::ParameterHandler prm;
    solver->add_parameters(prm);
    prm.parse_input_from_string(parameters);
    return solver;
  }

  /** Threads that stand for ranks: all discs' velocities and a few sums, with a barrier. */
  class Team
  {
  public:
    Team(const int n_ranks, const std::size_t n_discs)
      : discs(n_discs)
      , n_ranks(n_ranks)
    {}

    void wait()
    {
      std::unique_lock<std::mutex> lock(mutex);
      const int                    mine = turn;
      if (++n_waiting == n_ranks)
        {
          n_waiting = 0;
          ++turn;
          condition.notify_all();
        }
      else
        condition.wait(lock, [&] { return turn != mine; });
    }

    /** Combine values of all ranks, in the order in which they happen to come. */
    template <typename Combine>
    void combine(double *const values, const unsigned int n, const Combine &how)
    {
      wait();
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (n_arrived++ == 0)
          all.assign(values, values + n);
        else
          for (unsigned int k = 0; k < n; ++k)
            all[k] = how(all[k], values[k]);
      }
      wait();
      std::copy(all.begin(), all.begin() + n, values);
      wait();
      n_arrived = 0;
      wait();
    }

    std::vector<Disc> discs;

  private:
    const int               n_ranks;
    int                     n_waiting = 0, turn = 0, n_arrived = 0;
    std::vector<double>     all;
    std::mutex              mutex;
    std::condition_variable condition;
  };

  class TeamMember : public ContactCommunicator
  {
  public:
    TeamMember(Team &team, const std::vector<std::size_t> &global, const std::size_t n_owned)
      : team(team)
      , global(global)
      , n_owned(n_owned)
    {}

    void after_colour(std::vector<Disc> &discs, unsigned int) override { update_ghosts(discs); }

    void update_ghosts(std::vector<Disc> &discs) override
    {
      team.wait();
      for (std::size_t k = 0; k < n_owned; ++k)
        team.discs[global[k]] = discs[k];
      team.wait();
      for (std::size_t k = n_owned; k < global.size(); ++k)
        {
          discs[k].x = team.discs[global[k]].x;
          discs[k].y = team.discs[global[k]].y;
          discs[k].s = team.discs[global[k]].s;
        }
    }

    void sum(double *values, unsigned int n) override
    {
      team.combine(values, n, [](const double a, const double b) { return a + b; });
    }

    void max(double *values, unsigned int n) override
    {
      team.combine(values, n, [](const double a, const double b) { return std::max(a, b); });
    }

  private:
    Team                          &team;
    const std::vector<std::size_t> global;
    const std::size_t              n_owned;
  };

  /** Solve @p heap on several ranks, dealt out by @p owner; velocities of all discs. */
  std::vector<Disc> solve_on_ranks(const Heap                   &heap,
                                   const int                     n_ranks,
                                   const std::vector<int>       &owner,
                                   const std::string            &solver,
                                   const bool                    cold,
                                   std::vector<ContactSolution> &solutions)
  {
    const std::size_t        n = heap.x.size();
    Team                     team(n_ranks, n);
    std::vector<std::thread> threads;
    std::vector<Disc>        result(n);
    solutions.resize(n_ranks);
    for (int rank = 0; rank < n_ranks; ++rank)
      threads.emplace_back([&, rank] {
        std::vector<std::size_t> global;
        for (std::size_t k = 0; k < n; ++k)
          if (owner[k] == rank)
            global.push_back(k);
        const std::size_t        n_owned = global.size();
        std::vector<std::size_t> local(n + 4, n);
        for (std::size_t k = 0; k < n_owned; ++k)
          local[global[k]] = k;
        const auto mine = [&](const Contact &c) { return owner[c.i] == rank || (c.j < n && owner[c.j] == rank); };
        for (const Contact &c : heap.problem.contacts)
          if (mine(c))
            for (const std::size_t d : {c.i, c.j})
              if (d < n && local[d] == n)
                {
                  local[d] = global.size();
                  global.push_back(d);
                }
        Heap            part    = heap;
        ContactProblem &problem = part.problem;
        TeamMember      member(team, global, n_owned);
        problem.communicator  = &member;
        problem.n_discs       = global.size();
        problem.n_owned_discs = n_owned;
        problem.discs.assign(global.size() + 4, {});
        for (auto *v : {&part.x, &part.y, &part.radius, &part.weight})
          v->resize(global.size());
        for (std::size_t k = 0; k < global.size(); ++k)
          {
            problem.discs[k] = heap.problem.discs[global[k]];
            part.x[k]        = heap.x[global[k]];
            part.y[k]        = heap.y[global[k]];
            part.radius[k]   = heap.radius[global[k]];
            part.weight[k]   = heap.weight[global[k]];
          }
        problem.contacts.clear();
        problem.colour_begin = {0};
        for (std::size_t colour = 0; colour + 1 < heap.problem.colour_begin.size(); ++colour)
          {
            for (std::size_t k = heap.problem.colour_begin[colour]; k < heap.problem.colour_begin[colour + 1]; ++k)
              if (Contact c = heap.problem.contacts[k]; mine(c))
                {
                  c.i = local[c.i];
                  c.j = c.j < n ? local[c.j] : problem.n_discs + (c.j - n);
                  problem.contacts.push_back(c);
                }
            problem.colour_begin.push_back(problem.contacts.size());
          }
        ContactTolerance tolerance;
        tolerance.loose      = 1.;
        tolerance.residual   = 1e-4;
        tolerance.max_sweeps = 400;
        const auto plugin    = make_solver(solver);
        if (cold)
          solutions[rank] =
            solve_cold(problem, {part.x, part.y, part.radius}, {{{0., -1.}}, part.weight}, *plugin, tolerance);
        else
          solutions[rank] = plugin->solve(problem, tolerance);
        for (std::size_t k = 0; k < n_owned; ++k)
          result[global[k]] = problem.discs[k];
      });
    for (std::thread &t : threads)
      t.join();
    return result;
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
      tolerance.loose                = 1.;
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
      tolerance.residual   = 1e-8;
      tolerance.loose      = 1.;
      tolerance.max_sweeps = 20000;
      const auto solution  = make_solver("Gauss-Seidel", "set Order = " + order)->solve(heap.problem, tolerance);
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
  tolerance.loose      = 1.;
  tolerance.residual   = 1e-7;
  tolerance.max_sweeps = 60;
  const auto solver    = make_solver("accelerated Gauss-Seidel");
  Heap       plain(40, 60), cold(40, 60);
  solver->solve(plain.problem, tolerance);
  solve_cold(cold.problem, {cold.x, cold.y, cold.radius}, {{{0., -1.}}, cold.weight}, *solver, tolerance);
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
    tolerance.loose                = 1.;
    const ContactSolution solution = choice.get().solve(heap.problem, tolerance);
    EXPECT_TRUE(solution.converged);
    return solution.sweeps;
  };
  for (const std::string parameter : {"Largest momentum = 0.5", "Largest momentum = 0.95"})
    EXPECT_NEAR(sweeps("work queue", parameter) / (1. + sweeps("accelerated Gauss-Seidel", parameter)), 1., 0.05)
      << parameter;
  EXPECT_GT(sweeps("work queue", "Largest momentum = 0.5"), 2 * sweeps("work queue", "Largest momentum = 0.95"));
}
