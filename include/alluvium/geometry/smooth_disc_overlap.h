#pragma once

#include <alluvium/geometry/disc_polygon_overlap.h>

namespace alluvium::geometry
{
  /**
   * As overlap(), of a disc that is heavy in the middle and weighs nothing at its edge: 2 (1 - q^2/R^2) at the distance
   * q from the centre, which is 1 in the mean. Area, centroid and second moments are those of the weight over the
   * piece, exact to round-off of the whole disc (1e-15 of R^2, R^3, R^4) by Green's theorem along the piece's straight
   * edges and arcs. The mean of q^2 is R^2/3. Pieces that weigh less than 1e-13 R^2 are dropped; of all others the
   * centroid lies in the cell.
   */
  Overlap smooth_overlap(const Disc &disc, const PreparedPolygon &cell);
} // namespace alluvium::geometry
