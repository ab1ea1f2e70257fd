#pragma once

#include <alluvium/contacts/solvers/contact_communicator.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace alluvium::contacts
{
  /**
   * What all ranks of a contact step need to agree on. Collective over @p communicator, which is null on one rank; the
   * same bits on any number of them, if no rank's numbers count twice.
   */
  double      max_over_ranks(ContactCommunicator *communicator, double value);
  bool        any_over_ranks(ContactCommunicator *communicator, bool value);
  std::size_t count_over_ranks(ContactCommunicator *communicator, std::size_t value);

  /** The largest and the second largest of all, from those of every rank; neither is negative. */
  std::array<double, 2> largest_over_ranks(ContactCommunicator *communicator, std::array<double, 2> two_largest);

  /**
   * Sums over all ranks of terms(k), which are arrays of @p n_sums numbers, for k < @p n on this rank. The terms are
   * asked for twice. @p n_all: at least their number on all ranks, the same on any number of ranks.
   */
  template <unsigned int n_sums, class Terms>
  std::array<double, n_sums>
  sum_over_ranks(ContactCommunicator *communicator, const std::size_t n, const std::size_t n_all, const Terms &terms)
  {
    std::array<double, n_sums> values{};
    for (std::size_t k = 0; k < n; ++k)
      {
        const std::array<double, n_sums> t = terms(k);
        for (unsigned int s = 0; s < n_sums; ++s)
          values[s] = std::max(values[s], std::abs(t[s]));
      }
    if (communicator != nullptr)
      communicator->max(values.data(), n_sums);
    std::array<double, n_sums> shifts;
    for (unsigned int s = 0; s < n_sums; ++s)
      shifts[s] = ReproducibleSum(n_all * values[s]).unit_shift();
    values = {};
    for (std::size_t k = 0; k < n; ++k)
      {
        const std::array<double, n_sums> t = terms(k);
        for (unsigned int s = 0; s < n_sums; ++s)
          values[s] += (t[s] + shifts[s]) - shifts[s];
      }
    if (communicator != nullptr)
      communicator->sum(values.data(), n_sums);
    return values;
  }
} // namespace alluvium::contacts
