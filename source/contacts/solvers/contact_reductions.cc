#include <alluvium/contacts/solvers/contact_reductions.h>

namespace alluvium::contacts
{
  double max_over_ranks(ContactCommunicator *communicator, double value)
  {
    if (communicator != nullptr)
      communicator->max(&value, 1);
    return value;
  }

  bool any_over_ranks(ContactCommunicator *communicator, const bool value)
  {
    return max_over_ranks(communicator, value ? 1. : 0.) > 0.;
  }

  std::size_t count_over_ranks(ContactCommunicator *communicator, const std::size_t value)
  {
    double sum = value; // exact below 2^53
    if (communicator != nullptr)
      communicator->sum(&sum, 1);
    return static_cast<std::size_t>(sum);
  }

  std::array<double, 2> largest_over_ranks(ContactCommunicator *communicator, const std::array<double, 2> two_largest)
  {
    if (communicator == nullptr)
      return two_largest;
    const double      first = max_over_ranks(communicator, two_largest[0]);
    const bool        mine  = two_largest[0] == first;
    const double      rest  = max_over_ranks(communicator, mine ? two_largest[1] : two_largest[0]);
    const std::size_t n     = count_over_ranks(communicator, mine);
    return {{first, n > 1 ? first : rest}};
  }
} // namespace alluvium::contacts
