#include <alluvium/grains/wall.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  double project(const WallSegment &wall, const double x, const double y)
  {
    const double ex = wall.b[0] - wall.a[0], ey = wall.b[1] - wall.a[1], e2 = ex * ex + ey * ey;
    if (e2 == 0.)
      return 0.;
    return std::clamp(((x - wall.a[0]) * ex + (y - wall.a[1]) * ey) / e2, 0., 1.);
  }


  double distance_to(const WallSegment &wall, const double x, const double y)
  {
    const double t  = project(wall, x, y);
    const double dx = wall.a[0] + t * (wall.b[0] - wall.a[0]) - x, dy = wall.a[1] + t * (wall.b[1] - wall.a[1]) - y;
    return std::sqrt(dx * dx + dy * dy);
  }


  bool ever_acts(const WallSegment &wall)
  {
    return wall.motion ? wall.motion->ever_acts() : wall.velocity[0] != 0. || wall.velocity[1] != 0. || wall.spin != 0.;
  }


  double speed_of(const WallSegment &wall)
  {
    double speed = 0.;
    for (const auto &end : {wall.a, wall.b})
      {
        const auto v = wall.velocity_at(end[0], end[1]);
        speed        = std::max(speed, std::hypot(v[0], v[1]));
      }
    return speed;
  }


  std::vector<WallSegment> with_images(const std::vector<WallSegment> &walls, const Periodicity &periodicity)
  {
    std::vector<WallSegment> result = walls;
    for (unsigned int d = 0; d < 2; ++d)
      if (periodicity.length[d] > 0.)
        {
          const std::size_t n = result.size(); // images of images in the second direction: the corners
          for (const double shift : {-periodicity.length[d], periodicity.length[d]})
            for (std::size_t k = 0; k < n; ++k)
              {
                result.push_back(result[k]);
                for (auto *point : {&result.back().a, &result.back().b, &result.back().centre})
                  (*point)[d] += shift;
              }
        }
    return result;
  }
} // namespace alluvium::grains
