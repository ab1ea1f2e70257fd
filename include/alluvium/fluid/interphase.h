#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace alluvium::fluid
{
  /** Nodes of the largest cell: 4 in 2-D, 8 in 3-D (linear elements, quadrilateral or simplex). */
  template <int dim>
  constexpr unsigned int max_nodes = 1 << dim;

  /**
   * Where a piece of the solid, the intersection of a grain and a cell, sits in its cell: all that integrals of shape
   * functions over it need. Gradients at its centroid follow from phi and the cell, see piece_gradients(): pieces are
   * many, and what they cost is reading them.
   */
  template <int dim>
  struct PieceShape
  {
    double                             area; // [m^2], weights included
    std::array<double, max_nodes<dim>> phi;  // mean of each nodal shape function over the piece
  };

  /**
   * What a piece of the solid exchanges with the fluid, per unit of its area. With b = gamma * compliance its velocity
   * is v = a + b (u - u_ref) - compliance * grad p     (paper (15) for `semi-implicit`; a alone for the others) and the
   * force density on the solid is  gamma (u - v) + e - grad p, p the reduced pressure.
   */
  template <int dim>
  struct PieceExchange
  {
    double                  gamma      = 0.; // implicit drag [N s/m^4]
    double                  compliance = 0.; // [m^4/(N s)]
    std::array<double, dim> a          = {}; // known part of the solid velocity [m/s]
    std::array<double, dim> e          = {}; // explicit force density on the solid [N/m^3]
    double                  omega      = 0.; // known spin of the solid [rad/s], in a at the centroid; see PieceSpin
    std::uint8_t reference = 0; // which of VansProblem's reference velocity fields u_ref is; 0: none, u_ref = 0
  };

  /**
   * What a piece needs besides where the solid's spin is coupled to the fluid: the part of its drag that its centroid
   * does not see. There the solid has, besides its velocity at the centroid, (omega x + b grad (u - u_ref)) (x -
   * centroid), with omega and b = gamma * compliance from PieceExchange.
   */
  struct PieceSpin
  {
    std::array<double, 3> moments; // means of (x - centroid)^2, xy, yy over the piece [m^2]
    std::array<double, 2> arm;     // centroid minus the grain's centre [m]
    double                gamma;   // drag [N s/m^4]
  };

  /** The solid as the fluid sees it: pieces sorted by cell, in the order of FluidSpace::cells(). */
  template <int dim>
  struct InterphaseTerms
  {
    std::vector<unsigned int>       begin; // n_cells + 1 offsets into the two arrays below
    std::vector<PieceShape<dim>>    shape;
    std::vector<PieceExchange<dim>> exchange;
    std::vector<PieceSpin>          spin = {}; // empty: not coupled; in two dimensions only

    std::size_t n_pieces() const { return shape.size(); }
  };
} // namespace alluvium::fluid
