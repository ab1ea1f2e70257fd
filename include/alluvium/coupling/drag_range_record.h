#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <cstdint>
#include <vector>

namespace alluvium::coupling
{
  /** Which grains have ever been in conditions outside the range of the drag law; replicated, in the order of the
   * grains. */
  class DragRangeRecord
  {
  public:
    /** For @p n grains, of which those that were known stay. */
    void resize(const std::size_t n) { outside.resize(n, 0); }
    void note(const std::size_t g) { outside[g] = 1; }

    /** Grains have been taken out: @p keep says which stay. */
    void remove_grains(const std::vector<std::uint8_t> &keep);

    std::vector<grains::GrainId> ids(const grains::GrainArrays &grains) const;

    /** For checkpoints. */
    const std::vector<std::uint8_t> &flags() const { return outside; }
    void                             set_flags(std::vector<std::uint8_t> flags) { outside = std::move(flags); }

  private:
    std::vector<std::uint8_t> outside;
  };
} // namespace alluvium::coupling
