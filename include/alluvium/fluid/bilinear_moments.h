#pragma once

#include <alluvium/fluid/piece_gradients.h>

namespace alluvium::fluid
{
  /**
   * Sums over the pieces of a parallelogram of a coefficient times products of shape functions and gradients. With
   * (xi, eta) a piece's centroid and xi eta's mean apart from it, the shape functions are combinations of (1, xi, eta,
   * mean of xi eta), their gradients of b = (1, xi, eta): few sums for any number of pieces.
   */
  struct BilinearMoments
  {
    using Linear = std::array<double, 3>; // factors of 1, xi, eta

    std::array<Linear, 4> sums{}; // of (1, xi, eta, mean of xi eta) times b

    void add(const double coefficient, const std::array<double, 4> &phi)
    {
      const double xi = phi[1] + phi[3], eta = phi[2] + phi[3];
      const double f_xi = coefficient * xi, f_eta = coefficient * eta, f_product = coefficient * phi[3];
      sums[0][0] += coefficient;
      sums[0][1] += f_xi;
      sums[0][2] += f_eta;
      sums[1][1] += f_xi * xi;
      sums[1][2] += f_xi * eta;
      sums[2][2] += f_eta * eta;
      sums[3][0] += f_product;
      sums[3][1] += f_product * xi;
      sums[3][2] += f_product * eta;
    }

    /** Fill what is symmetric; after the last add(). */
    void close()
    {
      sums[1][0] = sums[0][1];
      sums[2][0] = sums[0][2];
      sums[2][1] = sums[1][2];
    }

    /** Sum of coefficient phi_i b. */
    std::array<Linear, 4> shapes() const
    {
      std::array<Linear, 4> result;
      for (unsigned int k = 0; k < 3; ++k)
        {
          result[3][k] = sums[3][k];
          result[1][k] = sums[1][k] - sums[3][k];
          result[2][k] = sums[2][k] - sums[3][k];
          result[0][k] = sums[0][k] - sums[1][k] - result[2][k];
        }
      return result;
    }

    /** Sum of coefficient b (b . @p factors). */
    Linear linear(const Linear &factors) const
    {
      Linear result;
      for (unsigned int k = 0; k < 3; ++k)
        result[k] = sums[k][0] * factors[0] + sums[k][1] * factors[1] + sums[k][2] * factors[2];
      return result;
    }

    static double dot(const Linear &a, const Linear &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  };

  /** The gradients of a parallelogram's four shape functions, [shape function][direction], as factors of b [1/m]. */
  inline std::array<std::array<BilinearMoments::Linear, 2>, 4> gradient_factors(const CellData<2> &cell)
  {
    std::array<std::array<BilinearMoments::Linear, 2>, 4> result;
    for (unsigned int d = 0; d < 2; ++d)
      {
        const double x = cell.to_reference[0][d], y = cell.to_reference[1][d];
        result[0][d] = {{-x - y, y, x}};
        result[1][d] = {{x, -y, -x}};
        result[2][d] = {{y, -y, -x}};
        result[3][d] = {{0., y, x}};
      }
    return result;
  }
} // namespace alluvium::fluid
