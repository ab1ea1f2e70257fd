#include <alluvium/fluid/piece_shape.h>

#include <cmath>

namespace alluvium::fluid
{
  PieceShape<2> piece_shape(const CellData<2>           &cell,
                            const unsigned int           n_nodes,
                            const double                 area,
                            const std::array<double, 2> &centroid,
                            const std::array<double, 3> &second_moments)
  {
    PieceShape<2> s{};
    s.area           = area;
    const auto &v    = cell.vertex;
    const auto  edge = [&](const unsigned int a, const unsigned int b) {
      return std::array<double, 2>{{v[b][0] - v[a][0], v[b][1] - v[a][1]}};
    };
    const std::array<double, 2> x = {{centroid[0] - v[0][0], centroid[1] - v[0][1]}};
    if (n_nodes == 3)
      {
        const auto   e = edge(0, 1), f = edge(0, 2);
        const double det = e[0] * f[1] - e[1] * f[0];
        s.phi[1]         = (x[0] * f[1] - x[1] * f[0]) / det;
        s.phi[2]         = (e[0] * x[1] - e[1] * x[0]) / det;
        s.phi[0]         = 1. - s.phi[1] - s.phi[2];
      }
    else
      {
        // invert x = e xi + f eta + g xi eta; affine cells need one step
        const auto                  e = edge(0, 1), f = edge(0, 2);
        const std::array<double, 2> g  = {{v[3][0] - v[1][0] - f[0], v[3][1] - v[1][1] - f[1]}};
        double                      xi = 0.5, eta = 0.5, det = 0.;
        std::array<double, 2>       a, b; // columns of the Jacobian at (xi, eta)
        for (unsigned int step = 0; step < (cell.parallelogram ? 1 : 20); ++step)
          {
            std::array<double, 2> r;
            for (unsigned int d = 0; d < 2; ++d)
              {
                const double bend = cell.parallelogram ? 0. : g[d];
                a[d]              = e[d] + bend * eta;
                b[d]              = f[d] + bend * xi;
                r[d]              = x[d] - e[d] * xi - f[d] * eta - bend * xi * eta;
              }
            det               = a[0] * b[1] - a[1] * b[0];
            const double dxi  = (r[0] * b[1] - r[1] * b[0]) / det;
            const double deta = (a[0] * r[1] - a[1] * r[0]) / det;
            xi += dxi;
            eta += deta;
            if (std::abs(dxi) + std::abs(deta) < 1e-14)
              break;
          }
        // mean of (xi - xi_c)(eta - eta_c)
        const double second = ((b[1] * second_moments[0] - b[0] * second_moments[1]) * -a[1] +
                               (b[1] * second_moments[1] - b[0] * second_moments[2]) * a[0]) /
                              (det * det * area);
        const double product = xi * eta + second;
        s.phi                = {{1. - xi - eta + product, xi - product, eta - product, product}};
      }
    return s;
  }
} // namespace alluvium::fluid
