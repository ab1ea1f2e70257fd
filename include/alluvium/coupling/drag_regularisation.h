#pragma once

#include <alluvium/coupling/drag_law.h>

namespace alluvium::coupling
{
  /**
   * Interface of what to do where the void fraction is far below that of any packing, as it is inside grains on fine
   * meshes without a filter: no drag law is meant for that, and all of them diverge as it goes to zero.
   */
  class DragRegularisation : public Plugin
  {
  public:
    /** gamma [N s/m^4] instead of @p law's own, for any void fraction from 0 to 1: above zero and finite. */
    virtual double gamma(const DragLaw &law, const DragState &state) const = 0;
  };
} // namespace alluvium::coupling

/** Register a drag regularisation under the name that parameter files use. */
#define ALLUVIUM_REGISTER_DRAG_REGULARISATION(Class, name, prose)                                                      \
  ALLUVIUM_REGISTER(::alluvium::coupling::DragRegularisation, Class, name, prose)
