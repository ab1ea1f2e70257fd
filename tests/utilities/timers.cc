#include <alluvium/utilities/timers.h>

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <thread>

using namespace alluvium;

TEST(Timers, AddUpByPhase)
{
  Timers timers;
  for (int i = 0; i < 3; ++i)
    {
      const auto outer = timers.scope("step");
      const auto inner = timers.scope("wait");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  const auto &phases = timers.all();
  ASSERT_EQ(phases.size(), 2u);
  EXPECT_EQ(phases.at("wait").calls, 3u);
  EXPECT_GE(phases.at("wait").wall, 0.03);
  EXPECT_GE(phases.at("step").wall, phases.at("wait").wall);
  EXPECT_LT(phases.at("wait").cpu, 0.5 * phases.at("wait").wall); // sleeping costs no CPU time
}

TEST(Timers, CountOnThrow)
{
  Timers timers;
  try
    {
      const auto timer = timers.scope("fails");
      throw 1;
    }
  catch (int)
    {}
  EXPECT_EQ(timers.all().at("fails").calls, 1u);
}

TEST(Timers, SlowestOfOneRankIsItsOwn)
{
  Timers timers;
  {
    const auto timer = timers.scope("a");
  }
  const auto slowest = timers.slowest(MPI_COMM_WORLD);
  ASSERT_EQ(slowest.size(), 1u);
  EXPECT_EQ(slowest.at("a").wall, timers.all().at("a").wall);
}

TEST(Timers, PrintTheDearestFirst)
{
  std::ostringstream out;
  print_timers(out, {{"cheap", {1., 0.5, 2}}, {"dear", {3., 3., 1}}}, 4.);
  EXPECT_EQ(out.str(),
            "phase   wall [s]    CPU [s]   share     calls\n"
            "dear       3.000      3.000  75.0 %         1\n"
            "cheap      1.000      0.500  25.0 %         2\n");
}
