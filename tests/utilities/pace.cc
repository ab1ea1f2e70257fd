// When a run tells that it takes far longer than expected.
#include <alluvium/utilities/pace.h>

#include <gtest/gtest.h>

namespace
{
  /** A run of 1 s whose steps take as long on the wall as they are told to. */
  struct TimedRun
  {
    double         wall = 0., time = 0.;
    alluvium::Pace pace;

    explicit TimedRun(const double expected)
      : pace(0., 1., expected, [this] { return wall; })
    {}

    bool step(const double dt, const double duration)
    {
      time += dt;
      wall += duration;
      return pace.falls_behind(time);
    }
  };
} // namespace

TEST(Pace, ARunAsLongAsExpectedIsNoNews)
{
  TimedRun run(500.);
  bool     was_said = false;
  for (unsigned int k = 0; k < 1000; ++k)
    was_said = run.step(1e-3, 1.) || was_said; // twice as long
  EXPECT_FALSE(was_said);
}

TEST(Pace, ALongRunIsToldOnceAndSoon)
{
  TimedRun     run(5.);
  unsigned int n_said = 0;
  for (unsigned int k = 0; k < 1000; ++k)
    if (run.step(1e-4, 0.5))
      {
        ++n_said;
        EXPECT_LT(run.wall, 31.);
        EXPECT_NEAR(run.pace.duration(), 5000., 100.);
        EXPECT_EQ(run.pace.expected(), 5.);
      }
  EXPECT_EQ(n_said, 1u);
}

TEST(Pace, ShortRunsAndSlowStartsAreNot)
{
  TimedRun run(1.);
  bool     was_said = false;
  for (unsigned int k = 0; k < 10; ++k)
    was_said = run.step(1e-9, 1.) || was_said; // the first steps are short
  for (unsigned int k = 0; k < 30; ++k)
    was_said = run.step(1. / 30., 1.) || was_said;
  EXPECT_FALSE(was_said); // 40 s in all
}

TEST(Pace, AStepThatStandsStillNeverEnds)
{
  TimedRun run(1.);
  EXPECT_FALSE(run.step(0., 10.));
  EXPECT_TRUE(run.step(0., 20.));
  EXPECT_GT(run.pace.duration(), 1e300);
}
