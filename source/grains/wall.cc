#include <alluvium/grains/wall.h>

namespace alluvium::grains
{
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
