#include <alluvium/contacts/solvers/hat_grid.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  void HatGrid::set(const std::array<double, 2> &lower,
                    const std::array<double, 2> &upper,
                    const std::array<double, 2> &period,
                    const double                 wanted,
                    const std::size_t            most)
  {
    for (unsigned int d = 0; d < 2; ++d)
      {
        periodic[d]          = period[d] > 0.;
        low[d]               = lower[d];
        const double length  = periodic[d] ? period[d] : upper[d] - lower[d];
        const auto   n_cells = static_cast<std::size_t>(std::clamp(std::round(length / wanted), 1., double(most)));
        size[d]              = length > 0. ? length / n_cells : 1.;
        n[d]                 = n_cells + (periodic[d] ? 0 : 1);
      }
    outer = width(0) < width(1) ? 0 : 1;
  }

  HatGrid::Hats HatGrid::at(const double x, const double y) const
  {
    const double               point[2] = {x, y};
    std::array<std::size_t, 2> first;
    double                     t[2];
    for (unsigned int d = 0; d < 2; ++d)
      {
        double u = (point[d] - low[d]) / size[d];
        if (periodic[d])
          u -= n[d] * std::floor(u / n[d]);
        else
          u = std::clamp(u, 0., n[d] - 1.);
        first[d] = std::min(static_cast<std::size_t>(u), n_cells(d) - 1);
        t[d]     = u - first[d];
      }
    const double a = 1. - t[0], b = t[0], c = 1. - t[1], e = t[1], ix = 1. / size[0], iy = 1. / size[1];
    Hats         hats;
    hats.cell  = first[1] * n_cells(0) + first[0];
    hats.node  = corners(first);
    hats.value = {{a * c, b * c, a * e, b * e}};
    hats.dx    = {{-c * ix, c * ix, -e * ix, e * ix}};
    hats.dy    = {{-a * iy, -b * iy, a * iy, b * iy}};
    return hats;
  }
} // namespace alluvium::contacts
