#pragma once

#include <alluvium/contacts/contact_margins.h>
#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/contacts/solvers/contact_problem.h>

namespace alluvium::contacts
{
  /** How the grains of some pairs lie to each other, and move. */
  struct PairGeometry
  {
    static constexpr unsigned int most = 128; // pairs

    double nx[most], ny[most];        // unit vector from i to j; (1, 0) where they are in the same place
    double distance[most], gap[most]; // [m]
    double bias[most];                // ContactMargins::bias() [m/s]
    double vn[most];                  // rate at which it grows [m/s]
    double approach[most];            // that times the distance [m^2/s]
  };

  /** Of @p n <= PairGeometry::most pairs of @p grains with the velocities of @p discs; nearest images count. */
  void find_geometry(const ContactPair         *pairs,
                     unsigned int               n,
                     const grains::GrainArrays &grains,
                     const std::vector<Disc>   &discs,
                     const grains::Periodicity &periodicity,
                     const ContactMargins      &margins,
                     PairGeometry              &geometry);

  /** The gaps of @p n contacts between @p grains; what those with walls get means nothing. */
  void find_gaps(const Contact             *contacts,
                 unsigned int               n,
                 const grains::GrainArrays &grains,
                 const grains::Periodicity &periodicity,
                 double                    *gaps);
} // namespace alluvium::contacts
