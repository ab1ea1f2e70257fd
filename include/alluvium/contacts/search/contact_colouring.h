#pragma once

#include <alluvium/contacts/search/contact_search.h>

namespace alluvium::contacts
{
  /**
   * Colour all @p candidates such that those of one colour share no grain: the sweeps then run without waiting for each
   * other. Visits the pairs in the order of a hash of their two ids, with ~wall (bits flipped) for a wall, and gives
   * each the first colour that is free at both grains (walls do not count), so that the colours depend on which pairs
   * there are, but not on how the grains are numbered. Returns the number of colours.
   */
  unsigned int colour_contacts(const grains::GrainArrays &grains, ContactCandidates &candidates);

  /** Sort @p pairs by their @p n_colours colours; those of one colour stay in their order. Returns where each went. */
  std::vector<std::uint32_t> sort_by_colour(std::vector<ContactPair> &pairs, unsigned int n_colours);
} // namespace alluvium::contacts
