#pragma once

#include <alluvium/run/model.h>

namespace alluvium::run
{
  /** Warn if there are nodes at which grains leave no room for the fluid, after set_up(). Collective. */
  void check_void_fraction(Model &m);

  /** Of a step whose linear solver failed: throws Divergence if that is why. */
  void blame_void_fraction(const Model &m);
} // namespace alluvium::run
