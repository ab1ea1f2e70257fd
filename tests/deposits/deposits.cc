// The deposits: where grains are at t = 0, and what they refuse.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_pour.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/grains/packing.h>
#include <alluvium/utilities/plugin.h>

#include "deposits_made.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::deposits;
using namespace alluvium::grains;

namespace
{
  DepositContext context(const double width = 5e-3, const double height = 2e-2)
  {
    DepositContext c;
    c.lower   = {{1e-3, -2e-3}};
    c.upper   = {{1e-3 + width, -2e-3 + height}};
    c.density = 2630.;
    c.gravity = {{0., -9.81}};
    return c;
  }

  using test::arrays;

  std::vector<NewGrain>
  make(const std::string &name, const std::string &parameters, const DepositContext &c = context())
  {
    return test::make(name, parameters, c);
  }

  std::vector<WallSegment> box(const DepositContext &c)
  {
    const auto &l = c.lower, &u = c.upper;
    return {{{{l[0], u[1]}}, l, {{0., 0.}}, "left"},
            {l, {{u[0], l[1]}}, {{0., 0.}}, "bottom"},
            {{{u[0], l[1]}}, u, {{0., 0.}}, "right"}};
  }

  bool same(const std::vector<NewGrain> &a, const std::vector<NewGrain> &b)
  {
    bool equal = a.size() == b.size();
    for (std::size_t k = 0; equal && k < a.size(); ++k)
      equal = a[k].x == b[k].x && a[k].y == b[k].y && a[k].radius == b[k].radius && a[k].density == b[k].density;
    return equal;
  }

  /** Packing of the middle of a bed: half-width strips at the walls and the free surface left out. */
  double packing(const std::vector<NewGrain> &new_grains, const DepositContext &c, const double y0, const double y1)
  {
    // Sampling on a fine raster is exact enough here.
    int          inside = 0, all = 0;
    const double x0 = c.lower[0] + 1e-3, x1 = c.upper[0] - 1e-3, h = 2e-5;
    for (double y = y0; y < y1; y += h)
      for (double x = x0; x < x1; x += h)
        {
          ++all;
          for (const NewGrain &s : new_grains)
            if (std::hypot(s.x - x, s.y - y) < s.radius)
              {
                ++inside;
                break;
              }
        }
    return double(inside) / all;
  }

  std::string message_of(const std::string &table)
  {
    const std::string file = "/tmp/alluvium_grains_" + std::to_string(getpid()) + ".csv";
    std::ofstream(file) << table;
    std::string message = "no error";
    try
      {
        make("file", "set File = " + file);
      }
    catch (const UserError &e)
      {
        message = e.what();
      }
    std::filesystem::remove(file);
    return message;
  }
} // namespace


TEST(Deposits, SettledBedStandsAndItsWallsCarryIt)
{
  const auto c          = context();
  const auto new_grains = make("settled bed", "set Number of grains = 500\nset Cache folder =");
  ASSERT_EQ(new_grains.size(), 500u);
  GrainArrays grains = arrays(new_grains);
  EXPECT_TRUE(find_overlaps(grains, box(c), 1e-3 * 2e-4).empty());
  const double phi = packing(new_grains, c, c.lower[1] + 5e-4, c.lower[1] + 2.5e-3);
  EXPECT_GT(phi, 0.79);
  EXPECT_LT(phi, 0.85);

  // Ten steps from cold (no impulses known) and ten warm ones: the walls carry the weight. A cold step alone is off by
  // some 2e-3, which the next gives back.
  ContactStepper stepper;
  stepper.set_walls(box(c));
  stepper.settings().residual_tolerance = 1e-6;
  GrainLoads loads;
  loads.reset(grains.n());
  double weight = 0.;
  for (std::size_t k = 0; k < grains.n(); ++k)
    {
      loads.force[1][k] = -grains.mass[k] * 9.81;
      weight += grains.mass[k] * 9.81;
    }
  const auto before = grains;
  for (const bool warm : {false, true})
    {
      double support = 0.;
      for (int step = 0; step < 10; ++step)
        {
          const ContactReport report = stepper.advance(grains, loads, 5e-4, {{0., -9.81}});
          for (const auto &[name, force] : report.wall_force)
            support -= 0.1 * force[1] / weight;
          EXPECT_EQ(report.n_unconverged + report.n_halvings, 0u);
          if (warm)
            {
              EXPECT_LT(report.n_sweeps, 1000u);
            }
        }
      EXPECT_NEAR(support, 1., 1e-4) << warm;
    }
  for (std::size_t k = 0; k < grains.n(); ++k)
    EXPECT_NEAR(grains.position[1][k], before.position[1][k], 2e-3 * 2e-4);
}

// A run that starts from a settled bed, without knowing its contact forces, leaves it where it is, with long steps and
// short ones.
TEST(Deposits, SettledBedStays)
{
  const auto c          = context(1e-2, 3e-2);
  const auto new_grains = make("settled bed", "set Number of grains = 2000\nset Cache folder =", c);
  for (const double dt : {1e-3, 1e-4})
    {
      GrainArrays    grains = arrays(new_grains);
      ContactStepper stepper;
      stepper.set_walls(box(c));
      stepper.settings().residual_tolerance = 1e-7;
      stepper.settings().rest_steps         = 0;
      GrainLoads loads;
      loads.reset(grains.n());
      double weight = 0., support = 0.;
      for (std::size_t k = 0; k < grains.n(); ++k)
        {
          loads.force[1][k] = -grains.mass[k] * 9.81;
          weight += grains.mass[k] * 9.81;
        }
      const auto n_steps = static_cast<int>(std::lround(0.01 / dt));
      for (int step = 0; step < n_steps; ++step)
        for (const auto &[name, force] : stepper.advance(grains, loads, dt, {{0., -9.81}}).wall_force)
          support -= force[1] / weight / n_steps;
      EXPECT_NEAR(support, 1., 1e-4) << dt;
      for (std::size_t k = 0; k < grains.n(); ++k)
        EXPECT_LT(std::hypot(grains.position[0][k] - new_grains[k].x, grains.position[1][k] - new_grains[k].y),
                  3e-4 * 2e-4)
          << dt;
    }
}

// Each disc lies on what was there before and in nobody else; a hundred thousand of them make rare events happen.
TEST(Deposits, PouredDiscsDoNotOverlap)
{
  constexpr double d = 2e-4;
  for (const auto &[looseness, periodic] : {std::make_pair(0., false), {0.3, false}, {0., true}})
    {
      const DepositBox box{{{-0.035, -0.1}}, {{0.035, 1.}}, {{periodic, false}}};
      Pour             pour(box, 0.6 * d, looseness);
      RandomNumbers    random(2);
      GrainArrays      grains;
      grains.resize(100000);
      for (std::size_t k = 0; k < grains.n(); ++k)
        {
          grains.id[k]          = static_cast<GrainId>(k);
          grains.radius[k]      = 0.5 * d * random.uniform(1., 1.2);
          const auto p          = pour.add(grains.radius[k], random);
          grains.position[0][k] = p[0];
          grains.position[1][k] = p[1];
        }
      DepositContext c;
      c.lower = box.lower;
      c.upper = box.upper;
      EXPECT_TRUE(find_overlaps(grains,
                                periodic ? std::vector<WallSegment>() : ::box(c),
                                1e-9 * d,
                                Periodicity{box.lower, {{periodic ? box.width() : 0., 0.}}})
                    .empty());
      const double packing = inner_packing_fraction(grains);
      EXPECT_GT(packing, looseness > 0. ? 0.72 : 0.80);
      EXPECT_LT(packing, looseness > 0. ? 0.78 : 0.82);
    }
}

// In a domain that is periodic in x, grains lie across its periodic boundary as they do elsewhere.
TEST(Deposits, PeriodicDomain)
{
  auto c        = context(6e-3, 2e-2);
  c.periodicity = {c.lower, {{6e-3, 0.}}};
  const std::vector<WallSegment> floor{{c.lower, {{c.upper[0], c.lower[1]}}, {{0., 0.}}, "bottom"}};
  for (const auto &[name, parameters] :
       {std::make_pair("lattice", "set Diameter = 2e-4\nset Spacing = 2.05e-4"),
        std::make_pair("random suspension", "set Area fraction = 0.4\nset Smallest gap = 1e-5"),
        std::make_pair("settled bed", "set Number of grains = 900\nset Cache folder ="),
        std::make_pair("settled bed", "set Number of grains = 0\nset Bed height = 4e-3\nset Cache folder =")})
    {
      const auto  new_grains = make(name, parameters, c);
      GrainArrays grains     = arrays(new_grains);
      int         n_over     = 0;
      double      at_seam = 0., inside = 0.; // area of discs in strips of ten diameters
      for (const NewGrain &s : new_grains)
        {
          ASSERT_GE(s.x, c.lower[0]);
          ASSERT_LE(s.x, c.upper[0]);
          n_over += s.x - s.radius < c.lower[0] || s.x + s.radius > c.upper[0];
          (std::abs(s.x - 0.5 * (c.lower[0] + c.upper[0])) > 2e-3 ? at_seam : inside) += s.radius * s.radius;
        }
      EXPECT_TRUE(find_overlaps(grains, floor, 1e-3 * 2e-4, c.periodicity).empty()) << name;
      if (name != std::string("lattice"))
        {
          EXPECT_GT(n_over, 5) << name;
          EXPECT_NEAR(at_seam / inside, 0.5, 0.04) << name;
        }
      else
        {
          EXPECT_EQ(new_grains.size(), 29u * 97u); // 6 mm hold 29 cells, a little wider than asked for
        }
    }
}

TEST(Deposits, PeriodicInBothDirections)
{
  auto c                 = context(2e-3, 3e-3);
  c.periodicity          = {c.lower, {{2e-3, 3e-3}}};
  const auto  new_grains = make("random suspension", "set Area fraction = 0.45\nset Smallest gap = 4e-6", c);
  GrainArrays grains     = arrays(new_grains);
  for (double &r : grains.radius)
    r += 1.9999e-6;
  EXPECT_TRUE(find_overlaps(grains, {}, 0., c.periodicity).empty());
  int n_over[2] = {0, 0};
  for (const NewGrain &s : new_grains)
    {
      n_over[0] += s.x - s.radius < c.lower[0] || s.x + s.radius > c.upper[0];
      n_over[1] += s.y - s.radius < c.lower[1] || s.y + s.radius > c.upper[1];
    }
  EXPECT_GT(n_over[0], 0);
  EXPECT_GT(n_over[1], 0);
  // A box that is not the whole domain has sides.
  for (const NewGrain &s : make("random suspension", "set Box = 1e-3, -2e-3, 2e-3, 1e-3\nset Area fraction = 0.3", c))
    EXPECT_GE(s.x, c.lower[0] + s.radius);
  EXPECT_THROW(make("settled bed", "set Number of grains = 10\nset Smallest diameter = 6e-4", c), UserError);
}

// A periodic bed leaves the mean velocity what it is: it neither falls nor drifts sideways once it has settled.
TEST(Deposits, PeriodicSettledBedStays)
{
  auto c                     = context(5e-3, 2e-2);
  c.periodicity              = {c.lower, {{5e-3, 0.}}};
  const auto  new_grains     = make("settled bed", "set Number of grains = 800\nset Cache folder =", c);
  GrainArrays grains         = arrays(new_grains);
  grains.initial_position[0] = grains.position[0];
  ContactStepper stepper;
  stepper.set_walls({{c.lower, {{c.upper[0], c.lower[1]}}, {{0., 0.}}, "bottom"}});
  stepper.set_periodicity(c.periodicity);
  stepper.settings().residual_tolerance = 1e-7;
  stepper.settings().rest_steps         = 0;
  GrainLoads loads;
  loads.reset(grains.n());
  double weight = 0., support = 0.;
  for (std::size_t k = 0; k < grains.n(); ++k)
    {
      loads.force[1][k] = -grains.mass[k] * 9.81;
      weight += grains.mass[k] * 9.81;
    }
  for (int step = 0; step < 10; ++step)
    support += stepper.advance(grains, loads, 1e-3, {{0., -9.81}}).wall_force["bottom"][1] / weight / -10.;
  EXPECT_NEAR(support, 1., 1e-4);
  for (std::size_t k = 0; k < grains.n(); ++k)
    EXPECT_LT(
      std::hypot(grains.position[0][k] - grains.initial_position[0][k], grains.position[1][k] - new_grains[k].y),
      1e-3 * 2e-4);
}

// Packing is measured exactly enough: a square lattice has pi / 4 (d / a)^2.
TEST(Deposits, PackingFraction)
{
  const auto new_grains = make("lattice", "set Diameter = 1e-4\nset Spacing = 1.25e-4\nset Box = 0, 0, 0.01, 0.01");
  EXPECT_NEAR(inner_packing_fraction(arrays(new_grains)), 0.25 * M_PI * 0.64, 0.01);
  EXPECT_EQ(inner_packing_fraction(arrays({new_grains[0], new_grains[1]})), 0.);
  EXPECT_EQ(inner_packing_fraction(GrainArrays()), 0.);
}

TEST(Deposits, SettledBedHasTheWantedPacking)
{
  const auto        c          = context();
  const std::string p          = "set Number of grains = 700\nset Cache folder =\nset Packing fraction = ";
  const auto        new_grains = make("settled bed", p + "0.80", c);
  EXPECT_NEAR(inner_packing_fraction(arrays(new_grains)), 0.80, 5e-3);
  EXPECT_THROW(make("settled bed", p + "0.9", c), UserError);
}

TEST(Deposits, SettledBedIsReproducibleAndCached)
{
  auto c              = context();
  c.directory         = "/tmp/alluvium_deposits_" + std::to_string(getpid());
  const std::string p = "set Number of grains = 200\nset Size ratio = 1\n";
  const auto        a = make("settled bed", p, c), from_cache = make("settled bed", p, c);
  const auto        fresh = make("settled bed", p + "set Cache folder =\n", c);
  EXPECT_TRUE(same(a, from_cache));
  EXPECT_TRUE(same(a, fresh));
  make("settled bed", p + "set Seed = 2\n", c);
  // A file of this name that another recipe made is not believed.
  for (const auto &file : std::filesystem::directory_iterator(c.directory + "/deposits"))
    {
      std::ifstream     in(file.path());
      std::stringstream text;
      text << in.rdbuf();
      EXPECT_NE(text.str().find("# measured: packing fraction"), std::string::npos);
      std::ofstream(file.path()) << "# another recipe\nx,y,radius\n0,0,1\n";
    }
  EXPECT_TRUE(same(a, make("settled bed", p, c)));
  EXPECT_TRUE(same(a, make("settled bed", p, c)));
  int files = 0;
  for ([[maybe_unused]] const auto &file : std::filesystem::directory_iterator(c.directory + "/deposits"))
    ++files;
  EXPECT_EQ(files, 2);
  std::filesystem::remove_all(c.directory);
}

// Nothing is written where a scene is only looked at; and where nothing can be, the bed is settled all the same.
TEST(Deposits, SettledBedWithoutACache)
{
  auto c              = context();
  c.moves             = false; // there is no wall below the bed, of which moving grains would be warned
  c.directory         = "/tmp/alluvium_no_cache_" + std::to_string(getpid());
  const std::string p = "set Number of grains = 50\n";
  const auto        a = make("settled bed", p + "set Cache folder =\n", c);
  std::filesystem::create_directories(c.directory);
  c.may_write = false;
  EXPECT_TRUE(same(a, make("settled bed", p, c)));
  EXPECT_TRUE(std::filesystem::is_empty(c.directory));

  std::vector<std::string> warnings;
  c.may_write = true;
  c.warnings  = &warnings;
  std::ofstream(c.directory + "/deposits") << "a file where the folder should be";
  EXPECT_TRUE(same(a, make("settled bed", p, c)));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("not kept"), std::string::npos) << warnings[0];
  std::filesystem::remove_all(c.directory);
}

// A cache that was cut off, altered or is no file is made anew, with a word, to the same bits.
TEST(Deposits, SettledBedAndADamagedCache)
{
  auto c                      = context();
  c.moves                     = false; // as above
  c.directory                 = "/tmp/alluvium_damaged_cache_" + std::to_string(getpid());
  const std::string     p     = "set Number of grains = 100\n";
  const auto            whole = make("settled bed", p, c);
  std::filesystem::path file;
  for (const auto &entry : std::filesystem::directory_iterator(c.directory + "/deposits"))
    file = entry.path();
  std::stringstream kept;
  kept << std::ifstream(file).rdbuf();
  const std::string text = kept.str();

  std::vector<std::string> warnings;
  c.warnings                   = &warnings;
  const auto  last_line        = text.rfind('\n', text.size() - 2) + 1;
  std::string altered          = text;
  altered[altered.size() - 20] = altered[altered.size() - 20] == '1' ? '2' : '1';
  for (const std::string &bad : {text.substr(0, text.size() / 3), text.substr(0, last_line), altered, std::string()})
    {
      std::ofstream(file) << bad;
      warnings.clear();
      EXPECT_TRUE(same(whole, make("settled bed", p, c)));
      ASSERT_EQ(warnings.size(), 1u);
      EXPECT_NE(warnings[0].find("is cut off or was altered"), std::string::npos) << warnings[0];
      warnings.clear();
      EXPECT_TRUE(same(whole, make("settled bed", p, c))); // mended
      EXPECT_TRUE(warnings.empty());
    }
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_TRUE(same(whole, make("settled bed", p, c)));
  EXPECT_EQ(warnings.size(), 2u); // it is a folder, and it cannot be replaced
  std::filesystem::remove_all(c.directory);
}

// What cannot fit is refused by its area, before anything is poured; and numbers that are a mistake of the unit.
TEST(Deposits, WhatCannotFitIsRefusedAtOnce)
{
  const auto message = [](const std::string &deposit, const std::string &text) -> std::string {
    try
      {
        make(deposit, text + "\nset Box = 0, 0, 0.01, 0.02");
      }
    catch (const UserError &error)
      {
        return error.what();
      }
    return "";
  };
  const std::string bed = "set Cache folder =\nset Smallest diameter = 5e-4\nset Number of grains = ";
  for (const std::string n : {"10000", "100000", "4000000"})
    EXPECT_NE(message("settled bed", bed + n).find("cannot fit"), std::string::npos) << n;
  EXPECT_NE(message("settled bed", bed + "0\nset Bed height = 0.1").find("its box is only"), std::string::npos);
  EXPECT_EQ(message("settled bed", bed + "100"), "");
  for (const std::string &text : {std::string("set Cache folder =\nset Smallest diameter = 1e-7\nset Number of grains "
                                              "= 0\nset Bed height = 1e-2")})
    EXPECT_NE(message("settled bed", text).find("in mm?"), std::string::npos);
  EXPECT_NE(message("lattice", "set Diameter = 1e-8").find("in mm?"), std::string::npos);
  EXPECT_NE(message("random suspension", "set Smallest diameter = 1e-8").find("in mm?"), std::string::npos);
}

TEST(Deposits, SettledBedByHeight)
{
  const auto c          = context();
  const auto new_grains = make("settled bed", "set Number of grains = 0\nset Bed height = 2e-3\nset Cache folder =");
  double     top = -1., area = 0.;
  for (const NewGrain &s : new_grains)
    {
      top = std::max(top, s.y + s.radius - c.lower[1]);
      area += M_PI * s.radius * s.radius;
    }
  EXPECT_LT(top, 2.02e-3);
  EXPECT_NEAR(area / (5e-3 * 2e-3), 0.79, 0.05);
  EXPECT_THROW(make("settled bed", "set Number of grains = 0"), UserError);
  EXPECT_THROW(make("settled bed", "set Number of grains = 500\nset Cache folder =", context(5e-3, 1e-3)), UserError);
}

TEST(Deposits, Lattice)
{
  const auto new_grains = make("lattice", "set Diameter = 1e-3\nset Spacing = 2e-3\nset Box = 0, 0, 0.01, 0.006");
  ASSERT_EQ(new_grains.size(), 15u);
  EXPECT_NEAR(new_grains[0].x, 1e-3, 1e-15);
  EXPECT_NEAR(new_grains[14].y, 5e-3, 1e-15);
  const auto half = make("lattice", "set Diameter = 2e-4\nset Area fraction = 0.5");
  EXPECT_NEAR(half.size() * M_PI * 1e-8 / (5e-3 * 2e-2), 0.5, 0.03);
  EXPECT_THROW(make("lattice", "set Diameter = 1\n"), UserError);
  EXPECT_THROW(make("lattice", "set Diameter = 1e-3\nset Spacing = 0.9e-3"), UserError);
  EXPECT_THROW(make("lattice", "set Box = 0, 1"), UserError);
}

TEST(Deposits, RandomSuspension)
{
  const auto c          = context();
  const auto new_grains = make("random suspension", "set Area fraction = 0.4\nset Smallest gap = 1e-5", c);
  double     area       = 0.;
  for (const NewGrain &s : new_grains)
    area += M_PI * s.radius * s.radius;
  EXPECT_NEAR(area / (5e-3 * 2e-2), 0.4, 1e-3);
  GrainArrays grains = arrays(new_grains);
  for (double &r : grains.radius)
    r += 0.4999e-5;
  EXPECT_TRUE(find_overlaps(grains, box(c), 0.).empty());
  EXPECT_TRUE(same(new_grains, make("random suspension", "set Area fraction = 0.4\nset Smallest gap = 1e-5", c)));
  EXPECT_THROW(make("random suspension", "set Area fraction = 0.8", context(2e-3, 2e-3)), UserError);
  EXPECT_THROW(make("random suspension", "set Area fraction = 0"), UserError);
}

TEST(Deposits, FileIsReadWhateverItsColumnOrder)
{
  const std::string file = "/tmp/alluvium_table_" + std::to_string(getpid()) + ".csv";
  std::ofstream(file) << "# made by hand\nradius, x,y,vx\n1e-4,0.1,0.2,3\n\n2e-4, 0.3,-0.4 ,0\r\n";
  const auto new_grains = make("file", "set File = " + file);
  ASSERT_EQ(new_grains.size(), 2u);
  EXPECT_EQ(new_grains[0].vx, 3.);
  EXPECT_EQ(new_grains[1].y, -0.4);
  EXPECT_EQ(new_grains[1].density, 2630.);
  write_grain_table(file, {{1. / 3., 2. / 3., 1e-4 / 7., 2630.}}, "a comment");
  EXPECT_EQ(read_grain_table(file, 1.)[0].radius, 1e-4 / 7.);
  std::filesystem::remove(file);
}

TEST(Deposits, FileErrorsNameTheLine)
{
  const auto has = [](const std::string &message, const std::string &part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  has(message_of("x,y\n0,0\n"), "'radius' is missing");
  has(message_of("x,y,radius,colour\n"), "line 1: there is no column 'colour'");
  has(message_of("\xEF\xBB\xBFx,y,radius\n1,2\n"), "line 2: found 2 fields");
  has(message_of("\xFF\xFEx"), "saved as UTF-16");
  has(message_of("x;y;radius\n0,5;1;2\n"), "line 1: the columns are not separated by commas");
  has(message_of("x,y,radius\r0,0,-1\r"), "line 2: the radius");
  has(message_of("x,y,radius,x\n"), "twice");
  has(message_of("x,y,radius\n0,0,1\n0,nan,1\n"), "line 3: y = 'nan' is not a finite number");
  has(message_of("x,y,radius\n0,0,0\n"), "line 2: the radius must be positive");
  has(message_of("x,y,radius\n0,0,-1\n"), "line 2: the radius must be positive");
  has(message_of("x,y,radius\n0,zero,1\n"), "line 2: y = 'zero' is not a number");
  has(message_of("x,y,radius\n0,,1\n"), "is not a number");
  has(message_of("x,y,radius\n0,0\n"), "line 2: found 2 fields, but the header names 3 columns");
  has(message_of("x,y,radius\n"), "has no grains");
  has(message_of(""), "has no grains");
  EXPECT_THROW(make("file", ""), UserError);
  EXPECT_THROW(make("file", "set File = /nowhere.csv"), UserError);
}
