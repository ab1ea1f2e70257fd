#include <alluvium/fluid/fluid_space.h>

namespace alluvium::fluid
{
  template <int dim>
  void FluidSpace<dim>::build_on_numbers(const BoundaryConditions<dim> &boundary_conditions)
  {
    boundary_values.reinit(*this, boundary_conditions);
    cache.reinit(*this, boundary_values.constraints());
  }


  template class FluidSpace<2>;
} // namespace alluvium::fluid
