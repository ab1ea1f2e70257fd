#include <alluvium/contacts/solvers/disc_places.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <algorithm>
#include <limits>

namespace alluvium::contacts
{
  DiscExtent measure_extent(const ContactProblem &problem, const DiscPlaces &places)
  {
    const auto mass = [&](const std::size_t k) {
      return problem.discs[k].inverse_mass > 0. ? 1. / problem.discs[k].inverse_mass : 0.;
    };
    constexpr double none    = std::numeric_limits<double>::lowest();
    double           ends[6] = {none, none, none, none, 0., 0.};
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      {
        ends[0] = std::max(ends[0], -places.x[k]);
        ends[1] = std::max(ends[1], places.x[k]);
        ends[2] = std::max(ends[2], -places.y[k]);
        ends[3] = std::max(ends[3], places.y[k]);
        ends[4] = std::max(ends[4], places.radius[k]);
        ends[5] = std::max(ends[5], mass(k));
      }
    if (problem.communicator != nullptr)
      problem.communicator->max(ends, 6);
    ReproducibleSum radii(most_terms * ends[4]), masses(most_terms * ends[5]);
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      {
        radii.add(places.radius[k]);
        masses.add(mass(k));
      }
    double sums[3] = {radii.value(), static_cast<double>(problem.n_owned_discs), masses.value()};
    if (problem.communicator != nullptr)
      problem.communicator->sum(sums, 3);
    return {{{-ends[0], -ends[2]}}, {{ends[1], ends[3]}}, 2. * sums[0] / std::max(1., sums[1]), sums[1], sums[2]};
  }
} // namespace alluvium::contacts
