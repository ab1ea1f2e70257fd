#include <alluvium/utilities/nearest_name.h>

#include <gtest/gtest.h>

using namespace alluvium;

TEST(NearestName, CountsEdits)
{
  EXPECT_EQ(edit_distance("density", "density"), 0u);
  EXPECT_EQ(edit_distance("Density", "density"), 0u);
  EXPECT_EQ(edit_distance("densty", "density"), 1u);
  EXPECT_EQ(edit_distance("densiyt", "density"), 1u); // two neighbours swapped
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(NearestName, FindsTheLikelyOne)
{
  const std::vector<std::string> names = {"Density", "Viscosity", "Time step", "End time"};
  EXPECT_EQ(nearest_name("Viscocity", names), "Viscosity");
  EXPECT_EQ(nearest_name("time step", names), "Time step");
  EXPECT_EQ(nearest_name("Timestep", names), "Time step");
}

TEST(NearestName, FindsAPartOfOneNameOnly)
{
  EXPECT_EQ(nearest_name("density", {"Grain mass density", "Viscosity"}), "Grain mass density");
  EXPECT_EQ(nearest_name("density", {"Grain mass density", "Some fluid's density"}), "");
}

TEST(NearestName, DoesNotGuessWildly)
{
  EXPECT_EQ(nearest_name("Porosity model", {"Density", "Time step"}), "");
  EXPECT_EQ(nearest_name("x", {"y"}), "");
  EXPECT_EQ(nearest_name("anything", {}), "");
}
