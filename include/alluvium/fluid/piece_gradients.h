#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::fluid
{
  /** Gradients of the reference coordinates [coordinate][direction], where those of x are @p a and @p b. */
  inline std::array<std::array<double, 2>, 2> inverse_jacobian(const dealii::Tensor<1, 2> &a,
                                                               const dealii::Tensor<1, 2> &b)
  {
    const double det = a[0] * b[1] - a[1] * b[0];
    return {{{{b[1] / det, -b[0] / det}}, {{-a[1] / det, a[0] / det}}}};
  }

  /** The same for a quadrilateral, at a point of it. */
  inline std::array<std::array<double, 2>, 2>
  to_reference_at(const CellData<2> &cell, const double xi, const double eta)
  {
    const auto &v = cell.vertex;
    return inverse_jacobian((1. - eta) * (v[1] - v[0]) + eta * (v[3] - v[2]),
                            (1. - xi) * (v[2] - v[0]) + xi * (v[3] - v[1]));
  }

  /**
   * Gradients of a cell's @p n (3 or 4) shape functions at the centroid of a piece over which they have the means
   * @p phi: those of xi are phi_1 + phi_3, of eta phi_2 + phi_3, whatever that of xi eta is [1/m].
   */
  template <int n>
  std::array<std::array<double, 2>, n> piece_gradients(const CellData<2> &cell, const std::array<double, 4> &phi)
  {
    std::array<std::array<double, 2>, n> grad;
    if constexpr (n == 3)
      grad = {
        {{{-cell.to_reference[0][0] - cell.to_reference[1][0], -cell.to_reference[0][1] - cell.to_reference[1][1]}},
         cell.to_reference[0],
         cell.to_reference[1]}};
    else
      {
        const double xi = phi[1] + phi[3], eta = phi[2] + phi[3];
        const auto   to_reference   = cell.parallelogram ? cell.to_reference : to_reference_at(cell, xi, eta);
        const auto &[by_xi, by_eta] = to_reference;
        for (unsigned int d = 0; d < 2; ++d)
          {
            grad[0][d] = (eta - 1.) * by_xi[d] + (xi - 1.) * by_eta[d];
            grad[1][d] = (1. - eta) * by_xi[d] - xi * by_eta[d];
            grad[2][d] = -eta * by_xi[d] + (1. - xi) * by_eta[d];
            grad[3][d] = eta * by_xi[d] + xi * by_eta[d];
          }
      }
    return grad;
  }
} // namespace alluvium::fluid
