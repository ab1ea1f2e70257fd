#include <alluvium/fluid/bilinear_moments.h>

#include <gtest/gtest.h>

#include <random>

using namespace alluvium::fluid;

namespace
{
  using Gradients = std::array<std::array<double, 2>, 4>;

  CellData<2> cell_with(const std::array<dealii::Point<2>, 4> &vertices, const bool parallelogram)
  {
    CellData<2> cell{};
    cell.vertex        = vertices;
    cell.parallelogram = parallelogram;
    cell.to_reference  = inverse_jacobian(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    return cell;
  }

  std::array<double, 4> means(const double xi, const double eta, const double product)
  {
    return {{1. - xi - eta + product, xi - product, eta - product, product}};
  }

  double evaluate(const BilinearMoments::Linear &factors, const double xi, const double eta)
  {
    return factors[0] + factors[1] * xi + factors[2] * eta;
  }
} // namespace


// Sum over pieces first, then products of shape functions; or products first: the same.
TEST(BilinearMoments, SumsAreThoseOfTheirPieces)
{
  const CellData<2> cell = cell_with({{{0.3, 0.1}, {2.1, 0.4}, {0.6, 1.7}, {2.4, 2.0}}}, true);
  std::mt19937      rng(5);
  BilinearMoments   moments;
  double            shape_gradient[4][4][2] = {}, gradient_gradient[4][4][2][2] = {};
  const auto        factors = gradient_factors(cell);
  for (unsigned int k = 0; k < 30; ++k)
    {
      const auto   number = [&] { return std::uniform_real_distribution<>()(rng); };
      const double xi = number(), eta = number(), coefficient = number() - 0.3;
      const auto   phi  = means(xi, eta, xi * eta + 0.1 * (number() - 0.5));
      const auto   grad = piece_gradients<4>(cell, phi);
      moments.add(coefficient, phi);
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int c = 0; c < 2; ++c)
          {
            EXPECT_NEAR(evaluate(factors[i][c], xi, eta), grad[i][c], 1e-14);
            for (unsigned int j = 0; j < 4; ++j)
              {
                shape_gradient[i][j][c] += coefficient * phi[i] * grad[j][c];
                for (unsigned int d = 0; d < 2; ++d)
                  gradient_gradient[i][j][c][d] += coefficient * grad[i][c] * grad[j][d];
              }
          }
    }
  moments.close();
  const auto shapes = moments.shapes();
  for (unsigned int i = 0; i < 4; ++i)
    for (unsigned int j = 0; j < 4; ++j)
      for (unsigned int c = 0; c < 2; ++c)
        {
          EXPECT_NEAR(BilinearMoments::dot(shapes[i], factors[j][c]), shape_gradient[i][j][c], 1e-13);
          for (unsigned int d = 0; d < 2; ++d)
            EXPECT_NEAR(
              BilinearMoments::dot(moments.linear(factors[i][c]), factors[j][d]), gradient_gradient[i][j][c][d], 1e-13);
        }
}


// Gradients from the shape functions' means: those of x are (1, 0), of y (0, 1), on any cell.
TEST(PieceGradients, OfLinearFunctionsAreExact)
{
  const auto check = [](const auto &grad, const CellData<2> &cell) {
    std::array<std::array<double, 2>, 2> sum{};
    std::array<double, 2>                of_one{};
    for (unsigned int v = 0; v < grad.size(); ++v)
      for (unsigned int d = 0; d < 2; ++d)
        {
          of_one[d] += grad[v][d];
          for (unsigned int c = 0; c < 2; ++c)
            sum[c][d] += cell.vertex[v][c] * grad[v][d];
        }
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int d = 0; d < 2; ++d)
        EXPECT_NEAR(sum[c][d], c == d, 1e-14);
    EXPECT_NEAR(of_one[0], 0., 1e-14);
    EXPECT_NEAR(of_one[1], 0., 1e-14);
  };
  const CellData<2> bent = cell_with({{{0.3, 0.1}, {2.1, 0.4}, {0.2, 1.7}, {2.9, 1.5}}}, false);
  check(piece_gradients<4>(bent, means(0.2, 0.9, 0.17)), bent);
  const CellData<2> triangle = cell_with({{{0.3, 0.1}, {2.1, 0.4}, {0.2, 1.7}, {0., 0.}}}, true);
  check(piece_gradients<3>(triangle, {{0.2, 0.5, 0.3, 0.}}), triangle);
}
