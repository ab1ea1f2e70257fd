#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/run/restart_parameters.h>
#include <alluvium/run/restart_walls.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::run;

namespace
{
  grains::WallSegment wall(const std::string &name, const double x, const double vx = 0., const double spin = 0.)
  {
    grains::WallSegment result{{{x, 0.}}, {{x, 1.}}, {{0., 0.}}, name};
    if (vx != 0. || spin != 0.)
      {
        grains::WallMotion motion;
        motion.phases.push_back(
          {{{vx, 0., spin}}, -grains::WallMotion::for_ever, grains::WallMotion::for_ever, {}, ""});
        result.motion = std::make_shared<const grains::WallMotion>(motion);
        result.centre = {{x, 0.}};
      }
    return result;
  }

  ContactArchive::Entry entry(const grains::GrainId a, const std::uint32_t wall, const double rn)
  {
    return {a, ~wall, true, false, rn, 0., 0.};
  }

  std::vector<double> place(const ContactArchive &archive, const std::size_t k)
  {
    return {archive.wall_positions.begin() + 7 * k, archive.wall_positions.begin() + 7 * (k + 1)};
  }
} // namespace

TEST(RestartWalls, AWallPutIntoAGrainIsNamed)
{
  grains::GrainArrays grain;
  grain.resize(1);
  grain.id[0]          = 7;
  grain.position[0][0] = 0.5;
  grain.position[1][0] = 0.5;
  grain.radius[0]      = 0.1;
  const auto check     = [&](const grains::WallSegment &w) {
    ContactArchive archive;
    archive.wall_positions = WallGeometry::positions_of({w});
    check_room_at_walls(archive, {w}, grain, {});
  };
  EXPECT_NO_THROW(check(wall("beside", 0.61)));
  EXPECT_NO_THROW(check(wall("touching", 0.59))); // a twentieth of the diameter
  grains::WallSegment gone = wall("gone", 0.5);
  gone.present             = false;
  EXPECT_NO_THROW(check(gone));
  try
    {
      check(wall("new", 0.55));
      ADD_FAILURE();
    }
  catch (const UserError &error)
    {
      EXPECT_NE(std::string(error.what()).find("the wall 'new' now stands in grain 7"), std::string::npos)
        << error.what();
    }
}

TEST(RestartWalls, WallsInNewPlacesAreWhereTheirMotionHasBroughtThem)
{
  const std::vector<grains::WallSegment> before = {wall("a", 0., 0.1), wall("b", 1.), wall("c", 2., 0.5)};
  std::vector<grains::WallSegment>       moved  = before;
  moved[0].a[0] = moved[0].b[0] = moved[0].centre[0] = 0.7; // wherever the run has left it
  ContactArchive archive;
  archive.wall_positions = WallGeometry::positions_of(moved);
  archive.entries        = {entry(3, 0, 1.), entry(3, 1, 2.), entry(4, 1, 3.), entry(5, 2, 4.)};

  // 'b' is no more, 'c' stands elsewhere, 'd' is new and turns
  fit_to_walls(archive, before, {wall("c", 5., 0.5), wall("d", 6., 0., 0.25), wall("a", 0., -0.1)}, 2., 1e-3);
  EXPECT_NEAR(place(archive, 0)[0], 6., 1e-12);
  EXPECT_NEAR(place(archive, 1)[0], 6., 1e-12);
  EXPECT_NEAR(place(archive, 1)[2], 6. - std::sin(0.5), 1e-12);
  EXPECT_NEAR(place(archive, 1)[3], std::cos(0.5), 1e-12);
  EXPECT_EQ(place(archive, 2)[0], 0.7);
  ASSERT_EQ(archive.entries.size(), 1u);
  EXPECT_EQ(archive.entries[0].a, 3u);
  EXPECT_EQ(archive.entries[0].b, ~std::uint32_t(2));
  EXPECT_EQ(archive.entries[0].rn, 1.);
}

TEST(RestartWalls, WhatNoLongerMovesStaysWhereItIs)
{
  const std::vector<grains::WallSegment> before = {wall("a", 0., 0.1), wall("b", 1.)};
  std::vector<grains::WallSegment>       moved  = before;
  moved[0].a[0] = moved[0].b[0] = 0.7;
  moved[0].present              = false;
  ContactArchive archive;
  archive.wall_positions = WallGeometry::positions_of(moved);
  fit_to_walls(archive, before, {wall("a", 0.), wall("b", 1.)}, 2., 1e-3);
  EXPECT_EQ(place(archive, 0)[0], 0.7);
  EXPECT_EQ(place(archive, 0)[6], 1.); // nothing says any more that it is not there

  // and where nothing has moved or will, there is nothing to say
  archive = {};
  fit_to_walls(archive, {wall("a", 0.)}, {wall("b", 1.)}, 2., 1e-3);
  EXPECT_TRUE(archive.wall_positions.empty());
}

TEST(RestartWalls, AWallThatBeginsToTurnDoesSoAboutItsPoint)
{
  const std::vector<grains::WallSegment> before = {wall("a", 0., 0.1)};
  std::vector<grains::WallSegment>       moved  = before;
  moved[0].a[0] = moved[0].b[0] = 0.7;
  ContactArchive archive;
  archive.wall_positions  = WallGeometry::positions_of(moved);
  grains::WallSegment now = wall("a", 0., 0., 1.);
  now.centre              = {{0., 0.5}}; // in its middle, as it was at t = 0
  fit_to_walls(archive, before, {now}, 2., 1e-3);
  EXPECT_NEAR(place(archive, 0)[4], 0.7, 1e-15);
  EXPECT_NEAR(place(archive, 0)[5], 0.5, 1e-15);
}

TEST(RestartParameters, WhatWakesGrains)
{
  const auto wakes = [](const std::string &name) { return change_contacts({{name, "0", "1"}}); };
  for (const std::string name : {"Grains/Extra walls",
                                 "Grains/Fixed",
                                 "Gravity",
                                 "Contacts/Friction of single walls",
                                 "Contacts/Cohesion",
                                 "Contacts/Contact law: static and kinetic/Kinetic friction",
                                 "Contacts/Residual tolerance"})
    EXPECT_TRUE(wakes(name)) << name;
  for (const std::string name : {"Time/End time", "Output/Interval of pictures", "Fluid/Viscosity"})
    EXPECT_FALSE(wakes(name)) << name;
  EXPECT_FALSE(change_contacts({}));
  EXPECT_TRUE(change_walls({{"Time/End time", "", ""}, {"Grains/Motion of walls", "", ""}}));
  EXPECT_FALSE(change_walls({{"Grains/Fixed", "", ""}}));
}
