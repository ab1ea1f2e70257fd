#pragma once

#include <alluvium/coupling/flow_totals.h>

namespace alluvium::observers
{
  /** A change of the mesh during the run, and the flow before it, as carried over, and as the run goes on from it. */
  struct MeshChange
  {
    double               time           = 0.; // [s]
    unsigned long long   n_cells_before = 0, n_cells = 0;
    double               share         = 0.; // of the domain's area, where cells were refined or joined
    bool                 reinitialised = false;
    coupling::FlowTotals before, interpolated, after;
  };
} // namespace alluvium::observers
