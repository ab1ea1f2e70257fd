#include <alluvium/coupling/piece_list.h>

#include <algorithm>
#include <utility>

namespace alluvium::coupling
{
  PieceList PieceList::take()
  {
    PieceList old;
    old.terms.begin = std::move(terms.begin);
    old.terms.shape = std::move(terms.shape);
    old.grain       = std::move(grain);
    old.raw_area    = std::move(raw_area);
    old.arm         = std::move(arm);
    old.keeps_arms  = keeps_arms;
    terms.begin.clear();
    resize(0);
    return old;
  }


  void PieceList::reserve(const std::size_t n)
  {
    terms.shape.reserve(n);
    grain.reserve(n);
    raw_area.reserve(n);
  }


  void PieceList::resize(const std::size_t n)
  {
    terms.shape.resize(n);
    grain.resize(n);
    raw_area.resize(n);
    arm.resize(keeps_arms ? n : 0);
  }


  void PieceList::copy(const PieceList &old, const unsigned int cell, const std::size_t at)
  {
    const auto copy_array = [&](const auto &from, auto &to) {
      std::copy(from.begin() + old.terms.begin[cell], from.begin() + old.terms.begin[cell + 1], to.begin() + at);
    };
    copy_array(old.terms.shape, terms.shape);
    copy_array(old.grain, grain);
    copy_array(old.raw_area, raw_area);
    if (keeps_arms)
      copy_array(old.arm, arm);
  }
} // namespace alluvium::coupling
