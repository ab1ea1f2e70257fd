#pragma once

#include <alluvium/geometry/disc_polygon_overlap.h>
#include <alluvium/geometry/rectangle_grid.h>

#include <cstdint>

namespace alluvium::geometry
{
  /** What a disc and a rectangle have in common, in the rectangle's coordinates from 0 to 1. */
  struct GridPiece
  {
    unsigned cell;
    double   area;             // weighted [m^2]
    double   xi, eta, product; // means of xi, eta, xi eta over the piece; all four bilinear shape functions are >= 0
  };

  /** How the mass of a disc is spread over it, 1 in the mean: as for overlap(), or as for smooth_overlap(). */
  enum class DiscWeight
  {
    top_hat,
    parabolic
  };

  /**
   * Cuts discs with the cells of a RectangleGrid. With Q(x, y) the moments of the disc's part left of x and below y, a
   * piece is the alternating sum of Q over its corners, and Q is a polynomial in the coordinates, their chords' halves
   * and arc sines, for either weight: square roots and arc sines are found once a line. Exact to 1e-15 of the matching
   * power of the radius, as smooth_overlap() (overlap(): of the smaller one of radius and cell); top-hat pieces so
   * small that their means would lose digits are overlap()'s, parabolic ones below 1e-13 R^2 are dropped as
   * smooth_overlap()'s.
   */
  class GridCutter
  {
  public:
    /** Both must outlive this, @p polygons those that the grid is made of. */
    GridCutter(const RectangleGrid &grid, const std::vector<PreparedPolygon> &polygons, const DiscWeight weight);

    /** Append the pieces of @p disc in the cells that are @p wanted (empty: in all of them). */
    void cut(const Disc &disc, const std::vector<std::uint8_t> &wanted, std::vector<GridPiece> &pieces);

  private:
    /** A line x = t or y = t in units of the radius, about the centre. */
    struct Line
    {
      unsigned user = 0;  // number of the disc that the rest is of
      double   t    = 0.; // no further out than the circle
      // with s = sqrt(1 - t^2), smooth weight in brackets:
      double zeroth = 0.; // 1/2 (t s + asin t)  [+ 1/3 t s^3]
      double first  = 0.; // 1/3 s^3             [4/15 s^5]
    };

    const Line &find(const unsigned direction, const int index, const Disc &disc);

    template <DiscWeight weight>
    void cut_with(const Disc &disc, const std::vector<std::uint8_t> &wanted, std::vector<GridPiece> &pieces);

    const RectangleGrid                *grid;
    const std::vector<PreparedPolygon> *polygons;
    DiscWeight                          weight;
    std::array<std::vector<Line>, 2>    lines;
    unsigned                            n_discs = 0;
  };
} // namespace alluvium::geometry
