#include <alluvium/grains/grain_columns.h>

namespace alluvium::grains
{
  // or ranks, checkpoints and pictures would silently go without it
  static_assert(sizeof(GrainArrays) == sizeof(std::vector<GrainId>) + n_grain_numbers * sizeof(std::vector<double>),
                "An array of GrainArrays is not in grain_columns.");

  void GrainArrays::resize(const std::size_t size)
  {
    id.resize(size);
    for_each_column(*this, [&](std::vector<double> &values, const GrainColumn &) { values.resize(size, 0.); });
  }
} // namespace alluvium::grains
