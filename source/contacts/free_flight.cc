#include <alluvium/contacts/free_flight.h>

#include <algorithm>

namespace alluvium::contacts
{
  double
  FreeFlight::smallest_gap(const grains::GrainArrays &grains, const ContactGeometry &geometry, const double largest)
  {
    double                  gap   = largest;
    const ContactCandidates found = find_candidates(grains, geometry, largest);
    for (const ContactPair &pair : found.discs)
      gap = std::min(gap, touch(grains, geometry.periodicity, pair.i, pair.j).gap);
    ContactPoint point{};
    for (const ContactPair &pair : found.walls)
      if (geometry.walls.touch(
            pair.j, grains.position[0][pair.i], grains.position[1][pair.i], grains.radius[pair.i], point))
        gap = std::min(gap, point.gap);
    return gap;
  }


  bool FreeFlight::is_safe(const grains::GrainArrays &grains,
                           const grains::GrainLoads  &loads,
                           const double               dt,
                           const bool                 rotation,
                           const ContactGeometry     &geometry)
  {
    // drag is implicit: speeds go from those before the step to those after it without passing beyond either
    bodies.set(grains, loads, dt, rotation);
    double square = 0.;
    for (std::size_t k = 0; k < grains.n(); ++k)
      square = std::max({square,
                         grains.velocity[0][k] * grains.velocity[0][k] + grains.velocity[1][k] * grains.velocity[1][k],
                         bodies.free[k].x * bodies.free[k].x + bodies.free[k].y * bodies.free[k].y});
    const double approach = 2. * dt * std::sqrt(square); // of two at most
    if (gap <= approach)
      {
        constexpr double n_steps = 20.; // about as many until the next search
        const double     d       = 2. * *std::max_element(grains.radius.begin(), grains.radius.end());
        gap                      = smallest_gap(grains, geometry, std::max(0.5 * d, n_steps * approach));
      }
    const bool safe = gap > approach;
    gap -= approach;
    return safe;
  }


  void FreeFlight::move(grains::GrainArrays      &grains,
                        const grains::GrainLoads &loads,
                        const double              h,
                        const unsigned int        n_substeps,
                        const bool                rotation,
                        const ContactGeometry    &geometry)
  {
    for (unsigned int s = 0; s < n_substeps; ++s)
      {
        bodies.set(grains, loads, h, rotation);
        for (std::size_t k = 0; k < grains.n(); ++k)
          {
            grains.velocity[0][k] = bodies.free[k].x;
            grains.velocity[1][k] = bodies.free[k].y;
            if (rotation)
              grains.omega[k] += (bodies.free[k].s - grains.radius[k] * grains.omega[k]) / grains.radius[k];
            grains.position[0][k] += h * grains.velocity[0][k];
            grains.position[1][k] += h * grains.velocity[1][k];
          }
        wrap_into_box(grains, geometry.periodicity);
      }
  }
} // namespace alluvium::contacts
