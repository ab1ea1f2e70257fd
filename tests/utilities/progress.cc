#include <alluvium/utilities/progress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

using namespace alluvium;

TEST(Progress, Durations)
{
  EXPECT_EQ(hours_minutes_seconds(3725), "1:02:05");
  EXPECT_EQ(hours_minutes_seconds(59.6), "0:01:00");
  EXPECT_EQ(hours_minutes_seconds(-1), "?");
  EXPECT_EQ(hours_minutes_seconds(1. / 0.), "?");
}

TEST(Progress, LinesComeEveryFewSeconds)
{
  std::ostringstream out;
  double             wall = 100.;
  Progress           progress(MPI_COMM_SELF, 0., 64., Progress::Style::lines, out, [&] { return wall; });
  for (unsigned int step = 1; step <= 64; ++step)
    {
      wall += 0.125;
      progress.update(step, step, 1.);
    }
  EXPECT_EQ(out.str(), " 62 %  step 40  t = 40 s  dt = 1.00e+00 s  left 0:00:03\n");
  progress.finish();
  progress.finish();
  EXPECT_EQ(out.str(),
            " 62 %  step 40  t = 40 s  dt = 1.00e+00 s  left 0:00:03\n"
            "100 %  step 64  t = 64 s  dt = 1.00e+00 s  left 0:00:00\n");
}

TEST(Progress, SaysHowTheRunIsDoing)
{
  std::ostringstream out;
  double             wall = 0.;
  Progress           progress(MPI_COMM_SELF, 0., 4., Progress::Style::lines, out, [&] { return wall; });
  wall = 10.;
  progress.update(1, 2., 1., "Courant 0.3");
  EXPECT_EQ(out.str(), " 50 %  step 1  t = 2 s  dt = 1.00e+00 s  left 0:00:10  Courant 0.3\n");
}

TEST(Progress, BarStaysOnOneLine)
{
  std::ostringstream out;
  double             wall = 0.;
  Progress           progress(MPI_COMM_SELF, 1., 3., Progress::Style::bar, out, [&] { return wall; });
  wall = 10.;
  progress.update(1, 2., 1.);
  EXPECT_EQ(out.str(), "\r[==========          ]  50 %  step 1  t = 2 s  dt = 1.00e+00 s  left 0:00:10\033[K");
  wall += 0.01;
  progress.update(2, 2.5, 0.5); // too soon to be seen
  EXPECT_EQ(out.str().find("step 2"), std::string::npos);
  progress.finish();
  const std::string text = out.str();
  EXPECT_NE(text.find("step 2"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(Progress, NotesStandAlone)
{
  std::ostringstream out;
  Progress           progress(MPI_COMM_SELF, 0., 1., Progress::Style::lines, out);
  progress.note("first movement");
  EXPECT_EQ(out.str(), "first movement\n");
}

TEST(Progress, Silent)
{
  std::ostringstream out;
  double             wall = 0.;
  Progress           progress(MPI_COMM_SELF, 0., 1., Progress::Style::silent, out, [&] { return wall += 10.; });
  progress.update(1, 0.5, 0.5);
  progress.note("text");
  progress.finish();
  EXPECT_EQ(out.str(), "");
}
