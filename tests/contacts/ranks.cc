// The contact step on several ranks. Run under mpirun on 2, 3 and 4 of them; what needs no messages runs on one as
// well.
#include <alluvium/contacts/ranks/contact_partition.h>
#include <alluvium/contacts/ranks/contact_subdomain.h>
#include <alluvium/contacts/ranks/ghost_exchange.h>
#include <alluvium/contacts/search/contact_colouring.h>
#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/grains/grain_columns.h>

#include "contact_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>

using namespace alluvium::contacts;
using namespace alluvium::grains;
using namespace alluvium::contacts::test;

namespace
{
  int n_ranks()
  {
    int n;
    MPI_Comm_size(MPI_COMM_WORLD, &n);
    return n;
  }

  int my_rank()
  {
    int n;
    MPI_Comm_rank(MPI_COMM_WORLD, &n);
    return n;
  }

  double random_number(std::mt19937_64 &random)
  {
    return (random() >> 11) * 0x1p-53;
  }

  /** Discs of different sizes, thrown in a box in rows. */
  void throw_in(Scene &scene, const int n_columns, const int n_rows)
  {
    std::mt19937_64 random(11);
    for (int row = 0; row < n_rows; ++row)
      for (int column = 0; column < n_columns; ++column)
        scene.add((column + 0.75) * 1.3 * d + 0.1 * d * random_number(random),
                  (row + 0.6) * 1.2 * d,
                  0.2 * (random_number(random) - 0.5),
                  -0.1 * random_number(random),
                  r * (0.7 + 0.4 * random_number(random)));
  }

  void box(Scene &scene, const double width, const double speed = 0.)
  {
    scene.stepper.set_walls({{{{0., 1.}}, {{0., 0.}}, {{0., 0.}}, "left"},
                             {{{0., 0.}}, {{width, 0.}}, {{0., speed}}, "bottom"},
                             {{{width, 0.}}, {{width, 1.}}, {{0., 0.}}, "right"}});
  }

  void expect_same(const Scene &alone, const Scene &together, const int step)
  {
    const GrainArrays &a = alone.grains, &b = together.grains;
    const auto        &p = alone.report, &q = together.report;
    for (const GrainColumn &column : grain_columns)
      for (unsigned int c = 0; c < column.n_components; ++c)
        ASSERT_EQ(column.values(a, c), column.values(b, c)) << column.name << ' ' << c << ", step " << step;
    ASSERT_EQ(alone.stepper.touched(), together.stepper.touched()) << step;
    ASSERT_EQ(p.wall_force, q.wall_force) << step;
    ASSERT_EQ(p.n_contacts, q.n_contacts) << step;
    ASSERT_EQ(p.n_substeps, q.n_substeps) << step;
    ASSERT_EQ(p.n_halvings, q.n_halvings) << step;
    ASSERT_EQ(p.n_sweeps, q.n_sweeps) << step;
    ASSERT_EQ(p.n_updates, q.n_updates) << step;
    ASSERT_EQ(p.residual, q.residual) << step;
    ASSERT_EQ(p.violation, q.violation) << step;
    ASSERT_EQ(p.mean_penetration, q.mean_penetration) << step;
    ASSERT_EQ(p.max_penetration, q.max_penetration) << step;
    ASSERT_EQ(p.max_velocity, q.max_velocity) << step;
    ASSERT_EQ(p.n_corrections, q.n_corrections) << step;
    ASSERT_TRUE(p.smooth_velocity == q.smooth_velocity ||
                (std::isnan(p.smooth_velocity) && std::isnan(q.smooth_velocity)))
      << step;
  }

  void expect_same(const ContactArchive &a, const ContactArchive &b)
  {
    ASSERT_EQ(a.dt, b.dt);
    ASSERT_EQ(a.entries.size(), b.entries.size());
    for (std::size_t k = 0; k < a.entries.size(); ++k)
      {
        const auto &e = a.entries[k], &f = b.entries[k];
        ASSERT_EQ(e.a, f.a);
        ASSERT_EQ(e.b, f.b);
        ASSERT_EQ(e.wall, f.wall);
        ASSERT_EQ(e.rn, f.rn);
        ASSERT_EQ(e.rt, f.rt);
        ASSERT_EQ(e.rr, f.rr);
      }
  }

  /**
   * Two equal scenes, one of which each rank computes alone and one that all compute together: the bits are to be the
   * same, step by step.
   */
  struct Twins
  {
    Scene alone, together;

    template <class Use>
    void both(const Use &use)
    {
      use(alone);
      use(together);
    }

    void run(
      const double dt, const int n_steps, const bool messages = true, const std::function<void(int)> &before = [](int) {
      })
    {
      together.stepper.settings().least_grains_a_rank = 1;
      together.stepper.set_communicator(MPI_COMM_WORLD);
      for (int step = 0; step < n_steps && !testing::Test::HasFatalFailure(); ++step)
        {
          before(step);
          both([&](Scene &s) { s.step(dt); });
          expect_same(alone, together, step);
          if (step % 20 == 19)
            expect_same(alone.stepper.archive(), together.stepper.archive());
        }
      // or the test shows nothing
      EXPECT_EQ(together.stepper.traffic().n_messages > 0, messages && n_ranks() > 1);
    }
  };
} // namespace

TEST(Ranks, BisectionIsFair)
{
  std::mt19937_64     random(3);
  std::vector<double> x, y;
  for (int k = 0; k < 5000; ++k)
    {
      const double u = random_number(random);
      x.push_back(10. * u * u); // denser at one side
      y.push_back(random_number(random));
    }
  x[7] = 1e6; // one has flown away
  std::vector<std::uint32_t> work(x.size());
  double                     total = 0.;
  for (std::size_t k = 0; k < work.size(); ++k)
    total += work[k] = 1 + (random() % 6);
  for (const unsigned int n : {1u, 2u, 3u, 4u, 7u})
    {
      std::vector<double> sums(n, 0.);
      const auto          owner = bisect(x, y, work, n);
      for (std::size_t k = 0; k < owner.size(); ++k)
        sums.at(owner[k]) += work[k];
      for (const double s : sums)
        EXPECT_NEAR(s, total / n, 0.01 * total / n);
    }
  // All in one place: nothing to cut, and nobody lost
  const auto owner = bisect({1., 1., 1.}, {2., 2., 2.}, {1, 1, 1}, 3);
  EXPECT_EQ(owner.size(), 3u);
  EXPECT_TRUE(bisect({}, {}, {}, 4).empty());
}

// Whatever changes a ghost in a colour and is not known here comes from its owner, who sends it in the same order.
TEST(Ranks, BordersFitTogether)
{
  Scene scene;
  throw_in(scene, 12, 9);
  ContactGeometry geometry;
  geometry.walls.set({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}});
  ContactCandidates  all       = find_candidates(scene.grains, geometry, 0.5 * d);
  const unsigned int n_colours = colour_contacts(scene.grains, all);
  for (const unsigned int n : {2u, 3u, 5u})
    {
      const auto owner =
        bisect(scene.grains.position[0], scene.grains.position[1], std::vector<std::uint32_t>(scene.grains.n(), 1), n);
      std::vector<ContactPartition> parts;
      for (unsigned int rank = 0; rank < n; ++rank)
        parts.push_back(make_partition(owner, all, n_colours, rank));
      const auto numbers = [&](const unsigned int rank, std::vector<std::uint32_t> list) {
        for (std::uint32_t &k : list)
          k = parts[rank].grains[k];
        return list;
      };
      std::size_t n_owned = 0;
      for (unsigned int rank = 0; rank < n; ++rank)
        {
          n_owned += parts[rank].n_owned;
          // by rank, the colours after which a ghost is received
          std::set<std::pair<std::uint32_t, unsigned int>> received, due;
          for (const ContactHalo &b : parts[rank].halos)
            {
              const auto &back = parts[b.rank].halos;
              const auto  its =
                std::find_if(back.begin(), back.end(), [&](const ContactHalo &o) { return o.rank == rank; });
              ASSERT_TRUE(its != back.end());
              EXPECT_EQ(numbers(rank, b.send), numbers(b.rank, its->receive));
              for (unsigned int c = 0; c < n_colours; ++c)
                {
                  EXPECT_EQ(numbers(rank, b.colour_send[c]), numbers(b.rank, its->colour_receive[c]));
                  for (const std::uint32_t k : numbers(rank, b.colour_receive[c]))
                    received.emplace(k, c);
                }
            }
          const std::set<std::uint32_t> here(parts[rank].grains.begin(), parts[rank].grains.end());
          const auto                    changes = [&](const std::uint32_t k, const unsigned int colour) {
            if (here.count(k) && owner[k] != rank)
              due.emplace(k, colour);
          };
          std::size_t n_pairs = 0;
          for (const ContactPair &p : all.discs)
            if (owner[p.i] == rank || owner[p.j] == rank)
              ++n_pairs;
            else
              {
                changes(p.i, p.colour);
                changes(p.j, p.colour);
              }
          for (const ContactPair &p : all.walls)
            changes(p.i, p.colour);
          EXPECT_EQ(received, due);
          EXPECT_EQ(parts[rank].pairs.discs.size(), n_pairs);
        }
      EXPECT_EQ(n_owned, scene.grains.n());
    }
}

// Every rank writes into its own discs who they are; then it knows its ghosts.
TEST(Ranks, GhostsAreKnown)
{
  Scene scene;
  throw_in(scene, 12, 9);
  ContactGeometry    geometry;
  ContactCandidates  all       = find_candidates(scene.grains, geometry, 0.5 * d);
  const unsigned int n_colours = colour_contacts(scene.grains, all);
  const auto         owner     = bisect(
    scene.grains.position[0], scene.grains.position[1], std::vector<std::uint32_t>(scene.grains.n(), 1), n_ranks());
  const ContactPartition part = make_partition(owner, all, n_colours, my_rank());
  GhostExchange          exchange(MPI_COMM_WORLD);
  exchange.set_halos(part.halos);
  const std::size_t   n = part.grains.size();
  std::vector<double> first(n, -1.), second(n, -1.);
  std::vector<Disc>   discs(n);
  for (std::size_t k = 0; k < part.n_owned; ++k)
    {
      discs[k].x = first[k] = part.grains[k];
      discs[k].s = second[k] = 0.5 * part.grains[k];
    }
  exchange.update_ghosts({&first, &second});
  exchange.update_ghosts(discs);
  EXPECT_EQ(n > part.n_owned, n_ranks() > 1);
  for (std::size_t k = 0; k < n; ++k)
    {
      EXPECT_EQ(first[k], part.grains[k]);
      EXPECT_EQ(second[k], 0.5 * part.grains[k]);
      EXPECT_EQ(discs[k].x, part.grains[k]);
      EXPECT_EQ(discs[k].s, 0.5 * part.grains[k]);
    }
  double value = my_rank();
  exchange.max(&value, 1);
  EXPECT_EQ(value, n_ranks() - 1.);
  value = 1.;
  exchange.sum(&value, 1);
  EXPECT_EQ(value, n_ranks());
}

// A rank's share has all columns of its grains and ghosts, and brings back those that a step changes.
TEST(Ranks, SharesHaveAllColumns)
{
  Scene scene;
  throw_in(scene, 12, 9);
  GrainArrays &all    = scene.grains;
  double       number = 0.;
  for_each_column(all, [&](std::vector<double> &values, const GrainColumn &column) {
    if (column.name != std::string("position") && column.name != std::string("radius"))
      for (double &value : values)
        value = ++number;
  });
  const GrainArrays before = all;
  GrainLoads        loads;
  loads.reset(all.n());
  ContactGeometry geometry;
  geometry.walls.set({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}});
  ContactCandidates  pairs     = find_candidates(all, geometry, 0.5 * d);
  const unsigned int n_colours = colour_contacts(all, pairs);

  ContactSubdomain share(MPI_COMM_WORLD);
  share.divide(all, loads, pairs, n_colours);
  if (n_ranks() > 1)
    {
      EXPECT_LT(share.n_owned(), all.n());
    }
  EXPECT_GT(share.n_owned(), 0u);
  for (const GrainColumn &column : grain_columns)
    for (unsigned int c = 0; c < column.n_components; ++c)
      for (std::size_t k = 0; k < share.grains.n(); ++k)
        EXPECT_EQ(column.values(share.grains, c)[k], column.values(before, c)[share.number_of(k)]) << column.name;

  for_each_column(share.grains, [&](std::vector<double> &values, const GrainColumn &) {
    for (double &value : values)
      value = -value;
  });
  std::vector<std::uint8_t> touched(all.n());
  share.collect(all, touched);
  for (const GrainColumn &column : grain_columns)
    for (unsigned int c = 0; c < column.n_components; ++c)
      for (std::size_t k = 0; k < all.n(); ++k)
        EXPECT_EQ(column.values(all, c)[k],
                  column.values(before, c)[k] * (column.when == GrainColumn::When::changing ? -1. : 1.))
          << column.name;
}

// A heap falls, bounces, collapses sideways and comes to rest. Grains change their rank on the way, with impulses.
TEST(Ranks, CollapseHasTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    s.set("set Restitution = 0.3\nset Rolling friction coefficient = 0.05");
    throw_in(s, 12, 20);
    box(s, 60. * d);
  });
  twins.run(4e-4, 400);
  if (n_ranks() > 1)
    {
      double n_migrated = twins.together.stepper.traffic().n_migrated;
      MPI_Allreduce(MPI_IN_PLACE, &n_migrated, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
      EXPECT_GT(n_migrated, 50.);
    }
}

// A fluid step of many sub-steps and a search in the middle of a solve: small skin, high speeds.
TEST(Ranks, FastGrainsHaveTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    s.set("set Search skin = 0.01\nset Restitution = 0.9\nset Restitution threshold velocity = 1e-3");
    throw_in(s, 10, 10);
    for (std::size_t k = 0; k < s.grains.n(); ++k)
      s.grains.velocity[0][k] *= 10.;
    box(s, 14. * d);
  });
  twins.run(1e-3, 60);
}

TEST(Ranks, PeriodicBoxHasTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    throw_in(s, 12, 8);
    s.gx = 3.;
    Periodicity periodicity;
    periodicity.length = {{16. * d, 0.}};
    s.stepper.set_walls({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}});
    s.stepper.set_periodicity(periodicity);
  });
  twins.run(4e-4, 200);
}

TEST(Ranks, MovingWallsHaveTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    throw_in(s, 10, 8);
    box(s, 13.5 * d, 0.02);
  });
  twins.run(4e-4, 150);
}

// Friction and the motion of ghosts decide about it together.
TEST(Ranks, LawsHaveTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    s.set("set Contact law = static-kinetic\nset Restitution = 0.2\nset Rolling friction coefficient = 0.02\n"
          "subsection Contact law: static-kinetic\nset Static friction ratio = 1.5\n"
          "set Transition slip speed = 0.01\nend");
    throw_in(s, 12, 8);
    box(s, 22. * d);
  });
  twins.run(4e-4, 200);
}

// Enough discs at rest for a cold start
TEST(Ranks, ColdStartHasTheSameBits)
{
  Twins twins;
  twins.both([](Scene &s) {
    for (int row = 0; row < 30; ++row)
      for (int column = 0; column < 40; ++column)
        s.add((column + 0.5 + 0.5 * (row % 2)) * d, (0.5 + row * std::sqrt(0.75)) * d);
    box(s, 40.5 * d);
  });
  twins.run(1e-4, 3);
  EXPECT_GT(twins.alone.report.n_contacts, 2000u);
}

TEST(Ranks, SolversHaveTheSameBits)
{
  for (const std::string solver : {"Gauss-Seidel", "SOR", "accelerated Jacobi"})
    {
      Twins twins;
      twins.both([&](Scene &s) {
        s.set("set Contact solver = " + solver);
        throw_in(s, 10, 6);
        box(s, 20. * d);
      });
      twins.run(4e-4, 60);
    }
}

// What is not shared: every rank does it all.
TEST(Ranks, CohesionAndSoftSpheresAreNotShared)
{
  for (const std::string set :
       {"set Contact model = soft-sphere",
        "set Cohesion = constant force\nsubsection Cohesion: constant force\nset Force = 0.01\nend"})
    {
      Twins twins;
      twins.both([&](Scene &s) {
        s.set(set);
        throw_in(s, 6, 4);
        box(s, 12. * d);
      });
      twins.run(4e-4, 20, false);
    }
}

// The forces of contacts, and going on from a checkpoint, which all ranks have: as on one rank.
TEST(Ranks, ForcesAndRestartHaveTheSameBits)
{
  Twins      twins;
  const auto build = [](Scene &s) {
    throw_in(s, 10, 10);
    box(s, 24. * d);
  };
  twins.both(build);
  twins.run(4e-4, 100);
  const auto compare = [](const std::vector<ContactForce> &a, const std::vector<ContactForce> &b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
      {
        ASSERT_EQ(a[k].i, b[k].i);
        ASSERT_EQ(a[k].j, b[k].j);
        ASSERT_EQ(a[k].normal, b[k].normal);
        ASSERT_EQ(a[k].tangential, b[k].tangential);
      }
  };
  const auto forces = twins.alone.stepper.forces(twins.alone.grains);
  EXPECT_GT(forces.size(), 100u);
  compare(forces, twins.together.stepper.forces(twins.together.grains));

  Twins restarted;
  restarted.both(build);
  restarted.alone.grains = restarted.together.grains = twins.together.grains;
  const ContactArchive archive                       = twins.together.stepper.archive();
  restarted.both([&](Scene &s) { s.stepper.set_archive(archive); });
  twins.both([](Scene &s) { s.stepper.forget_search(); });
  restarted.run(4e-4, 20);
  twins.run(4e-4, 20);
  expect_same(twins.alone, restarted.together, 20);
}

// A bed at rest under a load that changes, whose moments are corrected.
TEST(Ranks, CorrectedMomentsHaveTheSameBits)
{
  for (const bool periodic : {false, true})
    {
      Twins        twins;
      const double width = 40. * 1.02 * d, dt = 1e-3;
      twins.both([&](Scene &s) {
        std::mt19937_64 random(5);
        for (int row = 0; row < 40; ++row)
          for (int column = 0; column < 40; ++column)
            s.add((column + 0.4 + 0.2 * (row % 2)) * 1.02 * d,
                  r + row * 0.92 * d,
                  0.,
                  0.,
                  r * (0.8 + 0.2 * random_number(random)));
        s.set("set Rolling friction coefficient = 0.05\nset Steps to rest = 0");
        if (periodic)
          {
            Periodicity periodicity;
            periodicity.length[0] = width;
            s.stepper.set_periodicity(periodicity);
            s.stepper.set_walls({{{{0., 0.}}, {{width, 0.}}, {{0., 0.}}, "floor"}});
          }
        else
          box(s, width);
        for (const double m : s.grains.mass)
          s.loads.drag.push_back(0.5 * m / dt);
      });
      unsigned int n_corrections = 0;
      twins.run(dt, 150, true, [&](const int step) {
        n_corrections += twins.alone.report.n_corrections;
        twins.both([&](Scene &s) { s.gy = -g * (1. - 0.01 * std::max(0, step - 130)); });
      });
      EXPECT_GT(n_corrections, 0u);
    }
}
