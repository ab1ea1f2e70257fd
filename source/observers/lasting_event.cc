#include <alluvium/observers/lasting_event.h>

namespace alluvium::observers
{
  void LastingEvent::begin(const double head, const double time)
  {
    *this   = {};
    begun   = true;
    at_head = head;
    at_time = time;
  }


  void LastingEvent::follow(const double value, const double dt, const double bound, const double hold)
  {
    constexpr double round_off = 1e-9;
    if (known || !begun)
      return;
    sum += dt * value;
    elapsed += dt;
    is_beyond = sum >= bound * elapsed;
    if (elapsed < hold * (1. - round_off))
      return;
    known = is_beyond;
    if (!known)
      *this = {};
  }


  std::array<double, 7> LastingEvent::state() const
  {
    return {{double(begun), double(is_beyond), double(known), at_head, at_time, elapsed, sum}};
  }


  void LastingEvent::set_state(const std::array<double, 7> &state)
  {
    begun     = state[0] != 0.;
    is_beyond = state[1] != 0.;
    known     = state[2] != 0.;
    at_head   = state[3];
    at_time   = state[4];
    elapsed   = state[5];
    sum       = state[6];
  }
} // namespace alluvium::observers
