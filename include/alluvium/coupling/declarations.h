#pragma once

// The classes of the fluid's side, for headers that only name them.
namespace alluvium::fluid
{
  struct FluidProperties;
  template <int dim>
  class BoundaryConditions;
  template <int dim>
  class FluidSpace;
  template <int dim>
  class VansSolver;
} // namespace alluvium::fluid

namespace alluvium::coupling
{
  class Coupling;
}
