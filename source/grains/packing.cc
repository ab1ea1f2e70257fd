#include <alluvium/grains/packing.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  double inner_packing_fraction(const GrainArrays &grains)
  {
    const std::size_t n = grains.n();
    if (n == 0)
      return 0.;
    const double        margin = 6. * *std::max_element(grains.radius.begin(), grains.radius.end());
    std::vector<double> y      = grains.position[1];
    const auto          high   = y.begin() + static_cast<std::ptrdiff_t>(0.98 * (n - 1));
    std::nth_element(y.begin(), high, y.end());
    const double top    = *high - margin,
                 bottom = *std::min_element(grains.position[1].begin(), grains.position[1].end()) + margin;
    const auto [a, b]   = std::minmax_element(grains.position[0].begin(), grains.position[0].end());
    const double left = *a + margin, right = *b - margin;
    if (!(left < right && bottom < top))
      return 0.;

    // Vertical lines, so close that every disc is cut by some fifty; or, where sizes differ by thousands, a million.
    const double spacing =
      std::max(*std::min_element(grains.radius.begin(), grains.radius.end()) / 25., 1e-6 * (right - left));
    const auto   n_lines = static_cast<long>(std::ceil((right - left) / spacing));
    const double step    = (right - left) / n_lines;
    double       length  = 0.;
    for (std::size_t k = 0; k < n; ++k)
      {
        const double r   = grains.radius[k];
        const long first = std::max(0L, static_cast<long>(std::ceil((grains.position[0][k] - r - left) / step - 0.5))),
                   last  = std::min(n_lines - 1,
                                   static_cast<long>(std::floor((grains.position[0][k] + r - left) / step - 0.5)));
        for (long line = first; line <= last; ++line)
          {
            const double dx   = left + (line + 0.5) * step - grains.position[0][k],
                         half = std::sqrt(std::max(0., r * r - dx * dx));
            length += std::max(
              0., std::min(top, grains.position[1][k] + half) - std::max(bottom, grains.position[1][k] - half));
          }
      }
    return length / (n_lines * (top - bottom));
  }
} // namespace alluvium::grains
