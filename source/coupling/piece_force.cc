#include <alluvium/coupling/piece_force.h>

#include <algorithm>
#include <cmath>

namespace alluvium::coupling
{
  PieceForce piece_force(const OverlapMap &map, const PieceState &state, const std::size_t k)
  {
    const auto       &x = map.terms().exchange[k];
    const auto       &f = state.latest[k];
    const PieceField  none{};
    const PieceField &lagged = x.reference == 0 ? none : x.reference == 1 ? state.old[k] : state.before_latest[k];
    const double      b      = x.gamma * x.compliance;
    PieceForce        result;
    for (unsigned int d = 0; d < 2; ++d)
      {
        result.velocity[d] = x.a[d] + b * (f.u[d] - lagged.u[d]) - x.compliance * f.grad_p[d];
        result.force[d]    = x.gamma * (f.u[d] - result.velocity[d]) + x.e[d] - f.grad_p[d];
      }
    return result;
  }


  double size_of_parts(const OverlapMap &map, const PieceState &state)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < std::min(map.grain().size(), state.latest.size()); ++k)
      {
        const auto &f = state.latest[k];
        const auto  v = piece_force(map, state, k).velocity;
        sum += map.terms().shape[k].area *
               (map.terms().exchange[k].gamma * (std::hypot(f.u[0], f.u[1]) + std::hypot(v[0], v[1])) +
                std::hypot(f.grad_p[0], f.grad_p[1]));
      }
    return sum;
  }
} // namespace alluvium::coupling
