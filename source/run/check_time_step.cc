#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/model.h>
#include <alluvium/run/scene_numbers.h>

#include <cmath>
#include <sstream>

namespace alluvium::run
{
  void check_time_step(Model &m, const double end_time)
  {
    if (!m.has_fluid || !m.grains_move || !m.coupling.keeps_grain_velocity())
      return;
    double mass = 0., volume = 0.;
    for (std::size_t i = 0; i < m.grains.n(); ++i)
      if (!std::isinf(m.grains.mass[i]))
        {
          mass += m.grains.mass[i];
          volume += grains::disc_volume(m.grains.fluid_radius[i]);
        }
    // that of the bed; of grains here and there, where there are most
    const double in_bed = find_scene_numbers(m, end_time).eps, eps = in_bed < 1. ? in_bed : m.coupling.report().eps_min;
    const double tau_p =
      coupling::HomogeneousBed{m.grains, m.solver.properties, eps}.relaxation_time(m.coupling.drag_law());
    if (!(mass > 0.) || !(tau_p > 0.) || !(eps > 0.))
      return;
    const double r     = (1. - eps) / eps * m.solver.properties.density * volume / mass;
    const double limit = 2. * eps * eps * (1. - r) * tau_p;
    if (m.time_step < limit)
      return;
    std::ostringstream text;
    text.precision(2);
    text << "Coupling/Time scheme = " << m.coupling.scheme_name() << ": grains of void fraction " << eps;
    if (r >= 1.)
      text << " and " << mass / volume / m.solver.properties.density
           << " times the fluid's density are unstable with it at any time step";
    else
      text << " are unstable with it at time steps above " << limit << " s, 2 eps^2 (1 - r) tau_p, and this one is "
           << m.time_step << " s";
    text << "; the default, iterated, has no such limit";
    m.warnings.add(text.str(), m.time);
  }
} // namespace alluvium::run
