// When a quantity passes a bound for good.
#include <alluvium/observers/lasting_event.h>

#include <gtest/gtest.h>

using alluvium::observers::LastingEvent;

namespace
{
  constexpr double bound = 0.98, hold = 5e-3;

  /** A share that passes 1 at @p at [s] and a spike of 1.5 in the step that ends at @p spike [s]: head = t. */
  LastingEvent run(const double dt, const double at, const double spike, const double end, const bool restarts = false)
  {
    LastingEvent event;
    for (unsigned int n = 1; n * dt < end + 0.5 * dt; ++n)
      {
        const double t     = n * dt;
        const double share = t > spike - 0.5 * dt && t < spike + 0.5 * dt ? 1.5 : 1. + (t - at);
        if (event.is_awaited() && share >= 1.)
          event.begin(t, t);
        event.follow(share, dt, bound, hold);
        if (!restarts)
          continue;
        LastingEvent other;
        other.set_state(event.state());
        event = other;
      }
    return event;
  }
} // namespace

TEST(LastingEvent, IsTheFirstThatLasts)
{
  for (const double dt : {1e-2, 1e-3, 1e-4})
    for (const bool restarts : {false, true})
      {
        const LastingEvent event = run(dt, 0.5, -1., 1., restarts);
        EXPECT_TRUE(event.has_happened());
        EXPECT_NEAR(event.head(), 0.5, 1.01 * dt) << dt;
        EXPECT_EQ(event.time(), event.head());
      }
}

TEST(LastingEvent, IsNoSpike)
{
  for (const double dt : {1e-3, 1e-5})
    {
      EXPECT_NEAR(run(dt, 0.5, 0.1, 1.).head(), 0.5, 1.01 * dt) << dt;
      EXPECT_FALSE(run(dt, 0.5, 0.1, 0.4).has_happened()) << dt;
    }
}

TEST(LastingEvent, IsBelievedAtTheEndUnlessSomethingSpeaksAgainstIt)
{
  EXPECT_TRUE(run(1e-4, 0.5, -1., 0.501).has_happened());
  EXPECT_FALSE(run(1e-4, 0.5, 0.1, 0.101).has_happened());
  EXPECT_FALSE(LastingEvent().has_happened());
}
