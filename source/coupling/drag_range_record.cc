#include <alluvium/coupling/drag_range_record.h>
#include <alluvium/grains/leavers.h>

namespace alluvium::coupling
{
  void DragRangeRecord::remove_grains(const std::vector<std::uint8_t> &keep)
  {
    grains::keep_some(outside, keep);
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
