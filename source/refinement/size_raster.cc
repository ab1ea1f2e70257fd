#include <alluvium/refinement/size_raster.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::refinement
{
  namespace
  {
    constexpr double max_buckets = 4e6;
  }


  void SizeRaster::reinit(const mesh::Box &new_domain, const std::array<bool, 2> &new_periodic, const double spacing)
  {
    domain              = new_domain;
    periodic            = new_periodic;
    const double width  = domain.upper[0] - domain.lower[0];
    const double height = domain.upper[1] - domain.lower[1];
    const double wanted = std::max(spacing, std::sqrt(width * height / max_buckets));
    for (unsigned int d = 0; d < 2; ++d)
      {
        const double length = domain.upper[d] - domain.lower[d];
        n[d]                = std::size_t(std::max(1., std::ceil(length / wanted * (1. - 1e-9))));
        side[d]             = length / n[d];
      }
    size.assign(n[0] * n[1], std::numeric_limits<double>::infinity());
  }


  SizeRaster::Range SizeRaster::buckets_in(const mesh::Box &box) const
  {
    // a box that ends on a bucket's edge shall not take the next one in by rounding
    constexpr double edge = 1e-6;
    Range            range;
    for (unsigned int d = 0; d < 2; ++d)
      {
        const double low  = std::floor((box.lower[d] - domain.lower[d]) / side[d] + edge),
                     high = std::max(low + 1., std::ceil((box.upper[d] - domain.lower[d]) / side[d] - edge));
        range.begin[d]    = std::size_t(std::clamp(low, 0., double(n[d])));
        range.end[d]      = std::size_t(std::clamp(high, 0., double(n[d])));
      }
    return range;
  }


  void SizeRaster::stamp_inside(const mesh::Box &box, const double wanted)
  {
    const Range range = buckets_in(box);
    for (std::size_t j = range.begin[1]; j < range.end[1]; ++j)
      for (std::size_t i = range.begin[0]; i < range.end[0]; ++i)
        size[j * n[0] + i] = std::min(size[j * n[0] + i], wanted);
  }


  void SizeRaster::stamp(const mesh::Box &box, const double wanted)
  {
    // its images beyond the periodic boundaries that it crosses
    std::array<std::array<double, 3>, 2> shifts{};
    std::array<unsigned int, 2>          n_shifts{{1, 1}};
    for (unsigned int d = 0; d < 2; ++d)
      if (periodic[d])
        {
          const double length = domain.upper[d] - domain.lower[d];
          if (box.lower[d] < domain.lower[d])
            shifts[d][n_shifts[d]++] = length;
          if (box.upper[d] > domain.upper[d])
            shifts[d][n_shifts[d]++] = -length;
        }
    for (unsigned int a = 0; a < n_shifts[0]; ++a)
      for (unsigned int b = 0; b < n_shifts[1]; ++b)
        stamp_inside({{{box.lower[0] + shifts[0][a], box.lower[1] + shifts[1][b]}},
                      {{box.upper[0] + shifts[0][a], box.upper[1] + shifts[1][b]}}},
                     wanted);
  }


  void SizeRaster::spread(const MPI_Comm communicator, const double growth)
  {
    MPI_Allreduce(MPI_IN_PLACE, size.data(), static_cast<int>(size.size()), MPI_DOUBLE, MPI_MIN, communicator);
    if (std::all_of(size.begin(), size.end(), [](const double s) { return std::isinf(s); }))
      return;

    // a distance transform by sweeps to and fro with the eight neighbours; periodic boundaries need a second round
    const double across = growth * side[0], up = growth * side[1], diagonal = std::hypot(across, up);
    const int    nx = static_cast<int>(n[0]), ny = static_cast<int>(n[1]);
    const auto   at = [&](int i, int j) {
      if (periodic[0])
        i = (i + nx) % nx;
      if (periodic[1])
        j = (j + ny) % ny;
      return i < 0 || i >= nx || j < 0 || j >= ny ? std::numeric_limits<double>::infinity()
                                                    : size[std::size_t(j) * n[0] + i];
    };
    bool       changed = true;
    const auto relax   = [&](const int i, const int j, const int back) {
      double      &s      = size[std::size_t(j) * n[0] + i];
      const double nearby = std::min({at(i + back, j) + across,
                                      at(i, j + back) + up,
                                      at(i + back, j + back) + diagonal,
                                      at(i - back, j + back) + diagonal});
      if (nearby < s)
        {
          s       = nearby;
          changed = true;
        }
    };
    for (unsigned int round = 0; changed && round < 4; ++round)
      {
        changed = false;
        for (int j = 0; j < ny; ++j)
          for (int i = 0; i < nx; ++i)
            relax(i, j, -1);
        for (int j = ny - 1; j >= 0; --j)
          for (int i = nx - 1; i >= 0; --i)
            relax(i, j, 1);
      }
  }


  double SizeRaster::smallest_in(const mesh::Box &box) const
  {
    const Range range  = buckets_in(box);
    double      result = std::numeric_limits<double>::infinity();
    for (std::size_t j = range.begin[1]; j < range.end[1]; ++j)
      result = std::min(
        result, *std::min_element(size.begin() + j * n[0] + range.begin[0], size.begin() + j * n[0] + range.end[0]));
    return result;
  }
} // namespace alluvium::refinement
