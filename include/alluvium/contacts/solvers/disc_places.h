#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>

#include <array>
#include <vector>

namespace alluvium::contacts
{
  /** Where the discs of a ContactProblem are, owned and ghosts. */
  struct DiscPlaces
  {
    const std::vector<double> &x, &y;  // centres [m]
    const std::vector<double> &radius; // [m]
  };

  /** The box that bounds the centres of all discs. */
  struct DiscExtent
  {
    std::array<double, 2> lower, upper; // [m]
    double                diameter;     // mean [m]
    double                n;            // number of discs
    double                mass;         // of those that move [kg/m]
  };

  /** Of the discs on all ranks, with the same bits on any number of them. Collective. */
  DiscExtent measure_extent(const ContactProblem &problem, const DiscPlaces &places);
} // namespace alluvium::contacts
