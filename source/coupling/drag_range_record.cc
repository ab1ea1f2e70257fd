#include <alluvium/coupling/drag_range_record.h>

namespace alluvium::coupling
{
  void DragRangeRecord::remove_grains(const std::vector<std::uint8_t> &keep)
  {
    if (outside.size() != keep.size())
      return;
    std::size_t n = 0;
    for (std::size_t g = 0; g < keep.size(); ++g)
      if (keep[g])
        outside[n++] = outside[g];
    outside.resize(n);
  }


  std::vector<grains::GrainId> DragRangeRecord::ids(const grains::GrainArrays &grains) const
  {
    std::vector<grains::GrainId> result;
    for (std::size_t g = 0; g < outside.size(); ++g)
      if (outside[g])
        result.push_back(grains.id[g]);
    return result;
  }
} // namespace alluvium::coupling
