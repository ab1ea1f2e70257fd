#pragma once

#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_box.h>

#include <array>
#include <string>
#include <vector>

namespace alluvium::deposits
{
  /**
   * What stands in the box of a deposit: obstacles of the mesh, piles, slopes, extra walls. The sides of the domain's
   * bounding box are not among them.
   */
  class DepositRoom
  {
  public:
    /** Radii are those of the deposit's grains [m]. */
    DepositRoom(const DepositContext &context, const DepositBox &box, double smallest_radius, double largest_radius);

    /** Is there nothing but the box? */
    bool empty() const { return segments.empty(); }

    /** Does a disc at (x, y) lie in the domain, with no wall nearer than @p radius [m]? */
    bool fits(double x, double y, double radius) const;

    /** Area of the part of the box that is in the domain [m^2]. */
    double area() const;

    const std::vector<grains::WallSegment> &walls() const { return segments; }

    /** Number and checksum of the walls, for the recipe of a bed. */
    std::string in_digits() const;

    /**
     * Which of @p new_grains, that have been poured as if there were no walls, fit, and can have come to where they are
     * from above: from where the sky is free above their surface; or, if that is nowhere, from anywhere at that height.
     */
    std::vector<bool> reachable(const std::vector<NewGrain> &new_grains) const;

  private:
    DepositBox                             box;
    double                                 smallest, cell; // radius of the smallest disc, width of a cell [m]
    int                                    nx, ny;
    std::vector<grains::WallSegment>       segments; // walls, and open sides
    std::vector<grains::WallSegment>       boundary; // all of it; empty if the domain is its bounding box
    std::vector<std::vector<unsigned int>> near;     // the walls that a disc in each cell may touch
    std::vector<std::vector<unsigned int>> in_row;   // the sides of the boundary that have points at its heights

    int  column(double x) const;
    int  row(double y) const;
    bool inside(double x, double y) const;
  };
} // namespace alluvium::deposits
