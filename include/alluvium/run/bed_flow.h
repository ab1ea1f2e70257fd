#pragma once

namespace alluvium::run
{
  struct Model;

  /** How the bed as it was at t = 0 stands to what flows. */
  struct BedFlow
  {
    bool has_head = false; // the bed reaches from side to side, and nothing flows past it: it has a differential head
    bool crosses  = false; // besides, there are open boundaries below and above it
  };

  /** The same on all ranks. */
  BedFlow flow_across_bed(const Model &model);
} // namespace alluvium::run
