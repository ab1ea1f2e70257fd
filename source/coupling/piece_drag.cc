#include <alluvium/coupling/piece_drag.h>

#include <cmath>

namespace alluvium::coupling
{
  void PieceDrag::add_parameters(dealii::ParameterHandler &prm)
  {
    law_choice.add_parameters(prm, "Drag law", "disc", "Closure for the drag f = gamma (u - v) per volume of grain.");
    regularisation_choice.add_parameters(
      prm,
      "Drag regularisation",
      "floor",
      "What to do where the void fraction is far below that of any packing: inside grains, on fine meshes without a "
      "filter.");
  }


  void PieceDrag::parse_parameters()
  {
    law_choice.parse_parameters();
    regularisation_choice.parse_parameters();
  }


  void PieceDrag::find(const fluid::FluidSpace<2>   &space,
                       const fluid::Vector          &eps,
                       const fluid::FluidProperties &fluid,
                       CouplingState                &state)
  {
    const OverlapMap  &map            = state.map;
    const auto        &terms          = map.terms();
    const DragLaw     &law            = law_choice.get();
    const auto        &regularisation = regularisation_choice.get();
    DragState          s{0., 0., 0., fluid.density, fluid.viscosity};
    const unsigned int n = space.n_nodes_per_cell();
    state.gamma.resize(terms.n_pieces());
    conditions.assign(2 * state.grains.n(), 0.);
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
        {
          const unsigned int g = map.grain()[k];
          s.eps                = 0.;
          for (unsigned int v = 0; v < n; ++v)
            s.eps += terms.shape[k].phi[v] * eps.local_element(space.cells()[c].node[v]);
          const auto   spin = state.spin_velocity(k);
          const double ux   = state.old[k].u[0] - state.grains.velocity[0][g] - spin[0];
          const double uy   = state.old[k].u[1] - state.grains.velocity[1][g] - spin[1];
          s.slip            = std::sqrt(ux * ux + uy * uy);
          s.diameter        = 2. * state.grains.fluid_radius[g];
          conditions[2 * g] += terms.shape[k].area * s.eps;
          conditions[2 * g + 1] += terms.shape[k].area * s.reynolds();
          state.gamma[k] = regularisation.gamma(law, s);
        }
  }
} // namespace alluvium::coupling
