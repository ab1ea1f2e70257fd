#pragma once

#include <alluvium/contacts/search/contact_search.h>

#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /**
   * Partition points over @p n_ranks ranks by recursive coordinate bisection: each cut is across the longer side of
   * what it divides and leaves as much @p work on both sides, in proportion to their ranks, as the places allow. The
   * same on every rank. Returns the owner of each.
   */
  std::vector<unsigned int> bisect(const std::vector<double>        &x,
                                   const std::vector<double>        &y,
                                   const std::vector<std::uint32_t> &work,
                                   unsigned int                      n_ranks);

  /** What a rank sends to another one and receives from it, in indices of its own discs; the other has the same order.
   */
  struct ContactHalo
  {
    unsigned int                            rank;
    std::vector<std::uint32_t>              send, receive; // all that are ghosts there, and here
    std::vector<std::vector<std::uint32_t>> colour_send,   // after each colour: those that pairs have changed which
      colour_receive;                                      // the receiver does not have
  };

  /** The part of one rank in a contact step: grains that it owns, and whatever may touch them. */
  struct ContactPartition
  {
    std::vector<unsigned int>  owner;       // of all grains
    std::vector<std::uint32_t> grains;      // those of this rank among all: its own, then ghosts, both in their order
    std::size_t                n_owned = 0; // grains that it owns
    ContactCandidates          pairs;       // with at least one grain of its own, in their order
    std::vector<ContactHalo>   halos;       // one for each rank that it shares pairs with
  };

  /** The part of @p rank, if grains belong to their @p owner; @p all pairs have one of @p n_colours colours. */
  ContactPartition make_partition(std::vector<unsigned int> owner,
                                  const ContactCandidates  &all,
                                  unsigned int              n_colours,
                                  unsigned int              rank);
} // namespace alluvium::contacts
