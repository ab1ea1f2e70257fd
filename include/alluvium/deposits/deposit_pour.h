#pragma once

#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_box.h>
#include <alluvium/utilities/random_numbers.h>

#include <vector>

namespace alluvium::deposits
{
  /**
   * Pours discs into a box one by one: each falls at a random place and rolls down over the others until it lies on two
   * supports (Visscher & Bolsterli, Nature 239, 1972). The best of a few throws, the lowest, is kept, so that the
   * surface grows level. A bed made so is at rest if nothing lay on top of its discs; friction and dynamics have to do
   * the rest. If @p looseness is above 0, that share of the discs stays where it lands and does not roll: too loose to
   * stand, and so a start from which dynamics finds the packing that friction allows. A box that is periodic in x has
   * no sides; it must be wider than four of the largest discs.
   */
  class Pour
  {
  public:
    Pour(const DepositBox &box, double largest_radius, double looseness = 0.);

    /** Drop one disc and keep it; returns its place. */
    std::array<double, 2> add(double radius, RandomNumbers &random);

  private:
    struct Disc
    {
      double x, y, r;
    };
    DepositBox                    box;
    double                        cell, column_width, looseness;
    int                           n_columns;
    std::vector<std::vector<int>> cells; // discs by cell, row by row upwards; grows with the bed
    std::vector<Disc>             discs;

    /** Disc @p k or its image, whichever is nearer to @p x. */
    Disc seen_from(double x, int k) const;
    int  column_of(double x) const;
    /** The columns from @p first to @p last that there are: call visit(column) once for each. */
    template <class Visit>
    void                  visit_columns(int first, int last, const Visit &visit) const;
    std::array<double, 2> roll(double x, double radius) const;
    /** The disc that a falling one lands on, -1 for the floor; @p y is where it starts, and then where it lands. */
    int land(double x, double &y, double radius, int except) const;
    template <class Visit>
    void visit_near(double x, double y, double reach, const Visit &visit) const;
  };
} // namespace alluvium::deposits
