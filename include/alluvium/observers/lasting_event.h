#pragma once

#include <array>

namespace alluvium::observers
{
  /**
   * When a quantity passed a bound for good: its mean from then on, over @p hold [s], is still beyond. What lets go for
   * an instant does not count: overlaps that open in one short step throw a bed off its floor for that step.
   */
  class LastingEvent
  {
  public:
    /** Whether it may begin: nothing is waited for, or known. */
    bool is_awaited() const { return !begun; }

    /** It is passed at @p head [m] and @p time [s], in a step that follow() is told of next. */
    void begin(double head, double time);

    /** In a step of length @p dt [s] the quantity is @p value; it lasts if at least @p bound. */
    void follow(double value, double dt, double bound, double hold);

    /** Whether it lasts, as far as is known; then head [m] and time [s] are those of begin(). */
    bool   has_happened() const { return begun && is_beyond; }
    double head() const { return at_head; }
    double time() const { return at_time; }

    /** For checkpoints. */
    std::array<double, 7> state() const;
    void                  set_state(const std::array<double, 7> &state);

  private:
    double at_head = 0., at_time = 0., elapsed = 0., sum = 0.; // since then [s], and of value times dt
    bool   begun = false, is_beyond = false, known = false;
  };
} // namespace alluvium::observers
