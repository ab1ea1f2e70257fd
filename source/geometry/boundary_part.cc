#include <alluvium/geometry/boundary_part.h>

#include <algorithm>
#include <cmath>

namespace alluvium::geometry
{
  std::vector<FacePart> divide_face(const std::vector<BoundaryPart> &parts,
                                    const unsigned int               id,
                                    const std::array<double, 2>     &a,
                                    const std::array<double, 2>     &b)
  {
    constexpr double      close  = 1e-9;
    const double          length = std::hypot(b[0] - a[0], b[1] - a[1]);
    std::vector<FacePart> taken, result;
    for (const auto &part : parts)
      if (part.side == id)
        {
          const double from = a[part.axis], along = b[part.axis] - from;
          FacePart     piece{part.id, 0., 1.};
          if (std::abs(along) > close * length)
            {
              const double low = (part.low - from) / along, high = (part.high - from) / along;
              piece.begin = std::max(0., std::min(low, high));
              piece.end   = std::min(1., std::max(low, high));
            }
          else if (from < part.low || from > part.high)
            continue;
          if (piece.begin < close)
            piece.begin = 0.;
          if (piece.end > 1. - close)
            piece.end = 1.;
          if (piece.end - piece.begin > close)
            taken.push_back(piece);
        }
    std::sort(taken.begin(), taken.end(), [](const auto &p, const auto &q) { return p.begin < q.begin; });
    double at = 0.;
    for (const auto &piece : taken)
      {
        if (piece.begin - at > close)
          result.push_back({id, at, piece.begin});
        result.push_back(piece);
        at = std::max(at, piece.end);
      }
    if (1. - at > close)
      result.push_back({id, at, 1.});
    return result;
  }
} // namespace alluvium::geometry
