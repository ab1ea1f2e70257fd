// The smooth error of a bed at rest: what is found of it, and what a correction leaves.
#include <alluvium/contacts/solvers/hat_grid.h>
#include <alluvium/contacts/solvers/moment_correction.h>

#include "heap.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace alluvium::contacts;
using namespace alluvium::contacts::test;

namespace
{
  constexpr std::array<double, 2> not_periodic = {{0., 0.}};
  constexpr double                d = 1e-3, g_dt = 9.81e-4;

  ContactTolerance tight()
  {
    ContactTolerance tolerance;
    tolerance.residual          = 1e-9;
    tolerance.violation         = 1e-7;
    tolerance.stagnation_factor = 1.;
    tolerance.max_sweeps        = 50000;
    return tolerance;
  }

  /** A heap that rests: its impulses solve it. */
  Heap resting_heap(const int n_columns, const int n_rows)
  {
    Heap heap(n_columns, n_rows);
    heap.problem.velocity_scale = g_dt;
    EXPECT_TRUE(make_solver("accelerated Gauss-Seidel")->solve(heap.problem, tight()).converged);
    return heap;
  }

  /** Multiply the impulse of each contact by factor(x, y) of its place, and the velocities accordingly. */
  template <class Factor>
  void scale(Heap &heap, const Factor &factor)
  {
    Heap free(heap);
    for (Contact &c : free.problem.contacts)
      {
        const double f = factor(heap.x[c.i] + heap.radius[c.i] * c.nx, heap.y[c.i] + heap.radius[c.i] * c.ny) - 1.;
        c.rn *= f;
        c.rt *= f;
      }
    for (RollingFriction &r : free.problem.rolling)
      r.impulse *= factor(0., 0.) - 1.;
    apply_impulses(free.problem); // of the changes alone
    heap.problem.discs = free.problem.discs;
    for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
      {
        heap.problem.contacts[k].rn += free.problem.contacts[k].rn;
        heap.problem.contacts[k].rt += free.problem.contacts[k].rt;
        if (!heap.problem.rolling.empty())
          heap.problem.rolling[k].impulse += free.problem.rolling[k].impulse;
      }
  }

  double kinetic_energy(const ContactProblem &problem)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < problem.n_discs; ++k)
      if (const Disc &v = problem.discs[k]; v.inverse_mass > 0.)
        sum += 0.5 * (v.x * v.x + v.y * v.y) / v.inverse_mass + 0.5 * v.s * v.s / v.inverse_rotation;
    return sum;
  }

  double mass(const Heap &heap)
  {
    double sum = 0.;
    for (const double w : heap.weight)
      sum += w / g_dt;
    return sum;
  }
} // namespace

// The hats add up to one, and a cell's are as near in the order of unknowns as the width of the band promises.
TEST(HatGrid, IsAPartitionOfUnity)
{
  for (const bool periodic_x : {false, true})
    for (const bool periodic_y : {false, true})
      for (const double width : {1., 2., 3., 4., 7., 30.})
        for (const double height : {1., 2., 5., 12.})
          {
            HatGrid grid;
            grid.set(
              {{1., -2.}}, {{1. + width, -2. + height}}, {{periodic_x ? width : 0., periodic_y ? height : 0.}}, 1., 20);
            std::set<std::size_t> positions;
            for (std::size_t k = 0; k < grid.n_nodes(); ++k)
              positions.insert(grid.position(k));
            EXPECT_EQ(positions.size(), grid.n_nodes());
            EXPECT_EQ(*positions.rbegin() + 1, grid.n_nodes());
            std::set<std::size_t> cells;
            for (double x = 0.9; x < 1.2 + width; x += 0.37)
              for (double y = -2.1; y < -1.9 + height; y += 0.37)
                {
                  const HatGrid::Hats hats = grid.at(x, y);
                  EXPECT_EQ(hats.node, grid.nodes(hats.cell));
                  EXPECT_LT(hats.cell, grid.n_cells());
                  double sum = 0., dx = 0., dy = 0.;
                  for (unsigned int a = 0; a < 4; ++a)
                    {
                      ASSERT_LT(hats.node[a], grid.n_nodes());
                      EXPECT_GE(hats.value[a], 0.);
                      sum += hats.value[a];
                      dx += hats.dx[a];
                      dy += hats.dy[a];
                      for (unsigned int b = 0; b < a; ++b)
                        {
                          const auto p = grid.position(hats.node[a]), q = grid.position(hats.node[b]);
                          ASSERT_LE(std::max(p, q) - std::min(p, q), grid.band_width());
                        }
                    }
                  EXPECT_NEAR(sum, 1., 1e-14);
                  EXPECT_NEAR(dx, 0., 1e-14);
                  EXPECT_NEAR(dy, 0., 1e-14);
                }
          }
}

// Its values interpolate what is linear, its gradients are that, and across a periodic boundary it goes on.
TEST(HatGrid, InterpolatesAndWraps)
{
  HatGrid grid;
  grid.set({{0., 0.}}, {{10., 8.}}, not_periodic, 2., 20);
  const auto linear = [](const double x, const double y) { return 3. + 2. * x - 5. * y; };
  for (const double x : {0.3, 4.1, 9.9})
    for (const double y : {0.2, 7.7})
      {
        const HatGrid::Hats hats  = grid.at(x, y);
        double              value = 0., dx = 0., dy = 0.;
        for (unsigned int a = 0; a < 4; ++a)
          {
            const double at = linear(2. * (hats.node[a] % 6), 2. * (hats.node[a] / 6));
            value += hats.value[a] * at;
            dx += hats.dx[a] * at;
            dy += hats.dy[a] * at;
          }
        EXPECT_NEAR(value, linear(x, y), 1e-12);
        EXPECT_NEAR(dx, 2., 1e-12);
        EXPECT_NEAR(dy, -5., 1e-12);
      }
  grid.set({{0., 0.}}, {{10., 8.}}, {{10., 0.}}, 2., 20);
  for (const double x : {0.3, 4.1, 9.9})
    for (const double shift : {-10., 10., 30.})
      {
        const HatGrid::Hats a = grid.at(x, 3.), b = grid.at(x + shift, 3.);
        EXPECT_EQ(a.node, b.node);
        for (unsigned int k = 0; k < 4; ++k)
          EXPECT_NEAR(a.value[k], b.value[k], 1e-13);
      }
}

// An error that is one factor everywhere is in the space: all of its energy is found, and a correction leaves nothing.
TEST(MomentCorrection, OneFactorIsFoundWhole)
{
  for (const bool rolls : {false, true})
    {
      Heap heap = resting_heap(12, 40);
      if (rolls) // any impulses will do: with what the discs do, they rest
        for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
          {
            const Contact &c     = heap.problem.contacts[k];
            const double   lever = c.j < heap.problem.n_discs ? 0.5 : 1.;
            heap.problem.rolling.push_back(
              {0.01 * std::sin(3. * k) * c.rn, 0., lever, c.j < heap.problem.n_discs ? 0.5 : 0., 0., 0.01});
          }
      for (const double factor : {0.95, 1.05, 1.2})
        {
          Heap other = heap;
          scale(other, [=](double, double) { return factor; });
          const double     before = kinetic_energy(other.problem);
          MomentCorrection moments;
          moments.begin(other.problem, other.places(), not_periodic);
          const auto estimate = moments.estimate(other.problem, 1);
          EXPECT_NEAR(estimate.kinetic_energy, before, 1e-9 * before);
          EXPECT_NEAR(estimate.gain, before, 1e-4 * before);
          EXPECT_NEAR(estimate.velocity, std::sqrt(2. * before / mass(heap)), 1e-4 * estimate.velocity);
          ASSERT_TRUE(moments.correct(other.problem, 1));
          EXPECT_LT(kinetic_energy(other.problem), 1e-4 * before) << factor;
          for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
            {
              const Contact &c = other.problem.contacts[k];
              ASSERT_GE(c.rn, 0.);
              ASSERT_LE(std::abs(c.rt), c.friction * c.rn * (1. + 1e-12));
              EXPECT_NEAR(c.rn, heap.problem.contacts[k].rn, 1e-2 * heap.problem.impulse_scale);
              if (rolls)
                EXPECT_NEAR(
                  other.problem.rolling[k].impulse, heap.problem.rolling[k].impulse, 1e-2 * heap.problem.impulse_scale);
            }
        }
      // one step is never longer than this
      Heap other = heap;
      scale(other, [](double, double) { return 0.8; });
      MomentCorrection moments;
      moments.begin(other.problem, other.places(), not_periodic);
      ASSERT_TRUE(moments.correct(other.problem, 1));
      for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
        EXPECT_NEAR(
          other.problem.contacts[k].rn, 0.88 * heap.problem.contacts[k].rn, 1e-9 * heap.problem.impulse_scale);
    }
}

// One that varies over the bed leaves little; velocities stay those of the impulses.
TEST(MomentCorrection, SmoothErrorLeavesLittle)
{
  Heap         heap   = resting_heap(50, 80);
  const double height = 80. * d, width = 50. * d;
  scale(heap,
        [&](const double x, const double y) { return 1. + 0.05 * (x / width - 0.5) * std::cos(3. * y / height); });
  const double     before = kinetic_energy(heap.problem);
  MomentCorrection moments;
  moments.begin(heap.problem, heap.places(), not_periodic);
  const double gain = moments.estimate(heap.problem, 5).gain;
  EXPECT_GT(gain, 0.95 * before);
  EXPECT_LT(gain, before);
  const Heap start = heap;
  ASSERT_TRUE(moments.correct(heap.problem, 5));
  // hats change within a disc, which the moments know to first order
  EXPECT_NEAR(kinetic_energy(heap.problem), before - gain, 0.01 * before);
  Heap change = start;
  for (std::size_t k = 0; k < change.problem.contacts.size(); ++k)
    {
      change.problem.contacts[k].rn = heap.problem.contacts[k].rn - start.problem.contacts[k].rn;
      change.problem.contacts[k].rt = heap.problem.contacts[k].rt - start.problem.contacts[k].rt;
    }
  apply_impulses(change.problem);
  for (std::size_t k = 0; k < heap.x.size(); ++k)
    {
      EXPECT_NEAR(heap.problem.discs[k].x, change.problem.discs[k].x, 1e-9 * g_dt);
      EXPECT_NEAR(heap.problem.discs[k].y, change.problem.discs[k].y, 1e-9 * g_dt);
      EXPECT_NEAR(heap.problem.discs[k].s, change.problem.discs[k].s, 1e-9 * g_dt);
    }
}

// Where discs move, each as it likes, nothing is changed.
TEST(MomentCorrection, MotionIsLeftAlone)
{
  Heap            heap = resting_heap(12, 40);
  std::mt19937_64 random(1);
  const auto      any = [&] { return 0.1 * g_dt * ((random() >> 11) * 0x1p-52 - 1.); };
  for (std::size_t k = 0; k < heap.x.size(); ++k)
    {
      heap.problem.discs[k].x = any();
      heap.problem.discs[k].y = any();
      heap.problem.discs[k].s = any();
    }
  const Heap       before = heap;
  MomentCorrection moments;
  moments.begin(heap.problem, heap.places(), not_periodic);
  EXPECT_FALSE(moments.is_due(4));
  EXPECT_TRUE(moments.is_due(5));
  EXPECT_FALSE(moments.correct(heap.problem, 5));
  EXPECT_FALSE(moments.is_due(24));
  EXPECT_TRUE(moments.is_due(25));
  for (std::size_t k = 0; k < heap.x.size(); ++k)
    EXPECT_EQ(heap.problem.discs[k].y, before.problem.discs[k].y);
  for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
    EXPECT_EQ(heap.problem.contacts[k].rn, before.problem.contacts[k].rn);
}

// In a periodic box the boundary is nowhere in particular.
TEST(MomentCorrection, SeamIsNowhere)
{
  Heap         heap  = resting_heap(60, 30);
  const double width = 80. * heap.radius[0] * 2., height = 30. * d;
  scale(heap, [&](const double x, const double y) { return 1. + 0.05 * std::sin(0.1 * x / d) * (1. - y / height); });
  double gain = 0., energy = 0.;
  for (const double shift : {0., 0.25, 0.5, 0.75}) // by whole cells
    {
      Heap other = heap;
      for (double &x : other.x)
        {
          x += shift * width;
          if (x > width)
            x -= width;
        }
      other.x[0] = heap.x[0] + shift * width; // so that the grid begins where it did
      MomentCorrection moments;
      moments.begin(other.problem, other.places(), {{width, 0.}});
      const double found = moments.estimate(other.problem, 0).gain;
      ASSERT_TRUE(moments.correct(other.problem, 0));
      const double left = kinetic_energy(other.problem);
      if (shift == 0.)
        {
          gain   = found;
          energy = left;
          EXPECT_GT(gain, 0.9 * kinetic_energy(heap.problem));
        }
      EXPECT_NEAR(found, gain, 0.02 * gain) << shift;
      EXPECT_NEAR(left, energy, 0.02 * gain) << shift;
    }
}

// The same bits on any number of ranks, however the discs are dealt out.
TEST(MomentCorrection, SameBitsOnAnyNumberOfRanks)
{
  for (const bool periodic : {false, true})
    {
      Heap            heap = resting_heap(30, 40);
      std::mt19937_64 random(1);
      scale(heap, [&](const double x, const double y) { return 1. + 0.05 * std::sin(100. * x + 200. * y); });
      for (std::size_t k = 0; k < heap.problem.contacts.size(); ++k)
        heap.problem.rolling.push_back(
          {0.001 * std::sin(3. * k) * heap.problem.contacts[k].rn, 0., 0.5, 0.5, 0., 0.01});
      std::vector<Disc>                       first;
      std::vector<MomentCorrection::Estimate> estimates(3);
      MomentCorrection::Estimate              alone;
      for (const int n_ranks : {1, 2, 3})
        {
          std::vector<int> owner(heap.x.size());
          for (std::size_t k = 0; k < owner.size(); ++k)
            owner[k] = n_ranks == 1 ? 0 : n_ranks == 2 ? (heap.x[k] > 11.3 * d) : static_cast<int>((7 * k + k / 5) % 3);
          const auto discs = on_ranks(heap, n_ranks, owner, [&](Heap &part, const int rank) {
            MomentCorrection moments;
            moments.begin(part.problem, part.places(), {{periodic ? 35. * d : 0., 0.}});
            EXPECT_TRUE(moments.correct(part.problem, 5));
            estimates[rank] = moments.estimate(part.problem, 6);
          });
          if (n_ranks == 1)
            {
              first = discs;
              alone = estimates[0];
              EXPECT_GT(alone.gain, 0.);
            }
          for (int rank = 0; rank < n_ranks; ++rank)
            {
              EXPECT_EQ(estimates[rank].gain, alone.gain) << n_ranks;
              EXPECT_EQ(estimates[rank].kinetic_energy, alone.kinetic_energy) << n_ranks;
              EXPECT_EQ(estimates[rank].velocity, alone.velocity) << n_ranks;
            }
          for (std::size_t k = 0; k < first.size(); ++k)
            {
              ASSERT_EQ(first[k].x, discs[k].x) << n_ranks;
              ASSERT_EQ(first[k].y, discs[k].y);
              ASSERT_EQ(first[k].s, discs[k].s);
            }
        }
    }
}

// A load that grows by a little everywhere is what sweeps take hundreds for.
TEST(MomentCorrection, LoadIncrementTakesFewSweeps)
{
  Heap heap = resting_heap(60, 100);
  for (std::size_t k = 0; k < heap.x.size(); ++k)
    {
      heap.problem.discs[k].x = 0.1 * g_dt * std::sin(1. * k);
      heap.problem.discs[k].s = 0.;
      heap.problem.discs[k].y = -1.05 * g_dt; // before the impulses of the old load
    }
  unsigned int sweeps[2];
  double       left[2];
  for (const bool corrects : {false, true})
    {
      Heap             other = heap;
      MomentCorrection moments;
      ContactTolerance tolerance;
      tolerance.residual = 4e-5;
      tolerance.smooth   = 1e-3;
      if (corrects)
        {
          moments.begin(other.problem, other.places(), not_periodic);
          other.problem.correction = &moments;
        }
      const auto solution = make_solver("accelerated Gauss-Seidel")->solve(other.problem, tolerance);
      EXPECT_TRUE(solution.converged);
      sweeps[corrects] = solution.sweeps;
      left[corrects]   = std::sqrt(2. * kinetic_energy(other.problem) / mass(heap)) / g_dt;
      if (corrects)
        EXPECT_LT(solution.smooth, 1e-3);
    }
  EXPECT_LT(sweeps[1], sweeps[0]);
  EXPECT_GT(left[0], 0.02); // of the 0.05 that the load has grown by
  EXPECT_LT(left[1], 0.001);
}

// No solve of a bed at rest ends with a large smooth velocity, however small the residual may be asked.
TEST(MomentCorrection, SmoothVelocityEndsNoSolve)
{
  Heap heap = resting_heap(60, 100);
  for (std::size_t k = 0; k < heap.x.size(); ++k)
    {
      heap.problem.discs[k].x = 0.1 * g_dt * std::sin(1. * k);
      heap.problem.discs[k].s = 0.;
      heap.problem.discs[k].y = -1.05 * g_dt;
    }
  for (const std::string solver : {"accelerated Gauss-Seidel", "Gauss-Seidel", "SOR", "accelerated Jacobi"})
    for (const double smooth : {1., 1e-3})
      {
        Heap             other = heap;
        MomentCorrection moments;
        moments.begin(other.problem, other.places(), not_periodic);
        other.problem.correction = &moments;
        ContactTolerance tolerance;
        tolerance.residual  = 1.;
        tolerance.violation = 10.;
        tolerance.smooth    = smooth;
        const auto solution = make_solver(solver)->solve(other.problem, tolerance);
        EXPECT_TRUE(solution.converged) << solver;
        EXPECT_EQ(solution.smooth < 1e-3, smooth < 1.) << solver << ' ' << solution.smooth;
      }
}
