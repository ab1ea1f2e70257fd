#pragma once

#include <alluvium/run/model.h>

namespace alluvium::run
{
  /**
   * Look at what boundary conditions ask for between now and @p end_time [s], after set_up(). Throws UserError for
   * values that are not finite, for an inlet that no part of its boundary sees, and for a box closed all around into
   * which more flows than out. Warns of pressures that are constant along a boundary that is not level. Collective.
   */
  void check_boundaries(Model &m, double end_time);
} // namespace alluvium::run
