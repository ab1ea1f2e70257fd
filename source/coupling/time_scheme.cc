#include <alluvium/coupling/time_scheme.h>

namespace alluvium::coupling
{
  void TimeScheme::loads(const CouplingState                      &state,
                         const std::vector<std::array<double, 2>> &force,
                         const GrainSums &,
                         const unsigned int,
                         grains::GrainLoads &loads) const
  {
    for (std::size_t g = 0; g < state.grains.n(); ++g)
      {
        const auto weight = state.submerged_weight(g);
        loads.force[0][g] = weight[0] + force[g][0];
        loads.force[1][g] = weight[1] + force[g][1];
        loads.drag[g]     = 0.;
      }
  }
} // namespace alluvium::coupling
