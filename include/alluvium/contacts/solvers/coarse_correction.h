#pragma once

#include <alluvium/contacts/solvers/disc_places.h>

#include <array>
#include <cstddef>
#include <vector>

namespace alluvium::contacts
{
  /**
   * The coarse problem of a bed at rest. Sweeps balance a disc against its neighbours at once, but a large part of the
   * bed against the rest only after many sweeps. Here the momentum of overlapping blocks of discs (bilinear hats on a
   * coarse grid) is brought to zero by scaling impulses: each by 1 + c(place, direction of its normal), where c is
   * bilinear in place and spanned by three functions of direction, so that every stress can be met. It solves a small
   * least-squares problem with a little preference for small c. Impulses that are scaled stay positive and within their
   * friction cones, which is why nothing is lost when the sweeps go on.
   */
  class CoarseCorrection
  {
  public:
    /** Blocks of a tenth of the bed, at least eight diameters. Collective. */
    CoarseCorrection(const ContactProblem &problem, const DiscPlaces &places);

    /** Root of the area of the bed's bounding box, in mean diameters. */
    double bed_size() const { return extent; }

    /** Norm of the blocks' momenta [kg m/s per root of kg]. Collective. */
    double unbalanced(const ContactProblem &problem);

    /** Scale the impulses; the velocities are left as they are. Needs the state after unbalanced(). Collective. */
    void balance(ContactProblem &problem);

  private:
    static constexpr unsigned int n_families = 3, reach = 2, width = 2 * reach + 1; // of the stencil
    static constexpr unsigned int block_size = 2 * n_families;                      // entries: families x directions

    /** The four hats that are not zero at a point. */
    struct Hats
    {
      std::size_t           column, row;
      std::array<double, 4> value; // lower left, lower right, upper left, upper right
    };

    const DiscPlaces    places;
    double              left = 0., bottom = 0., size = 1., extent = 0.;
    std::size_t         n_columns = 0, n_rows = 0;
    std::vector<double> momentum, weight; // of each node: x and y; 1 / root of mass
    std::vector<double> matrix;           // node of c x place of the test node in its stencil x block

    std::size_t n_nodes() const { return n_columns * n_rows; }
    std::size_t node(const Hats &hats, const unsigned int corner) const
    {
      return (hats.row + corner / 2) * n_columns + hats.column + corner % 2;
    }
    Hats hats_at(double x, double y) const;

    /** Call @p f(block of the matrix, node, test node) for all nodes and the test nodes in their stencils. */
    template <class Function>
    void for_each_neighbour(const Function &f) const;

    void assemble(const ContactProblem &problem);
    void add_contact(
      const Hats &hats, const Contact &contact, const Hats &test, const std::array<double, 4> &value, double shift);
    void                multiply(const std::vector<double> &c, std::vector<double> &result) const;
    void                multiply_transposed(const std::vector<double> &test, std::vector<double> &result) const;
    std::vector<double> solve() const;

    static std::array<double, n_families> families(const Contact &contact);
  };
} // namespace alluvium::contacts
