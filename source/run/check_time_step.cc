#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/model.h>
#include <alluvium/run/scene_numbers.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::run
{
  namespace
  {
    /** How the grains' velocity of t^n is stable; see doc/theory/coupling.md, Stability. */
    struct FrozenVelocity
    {
      double eps           = 1.;
      double r             = 0.; // (1 - eps)/eps over the density ratio
      double tau           = 0.; // relaxation time [s]
      double density_ratio = 0.;

      double limit() const { return r < 1. ? 2. * eps * eps * (1. - r) * tau : 0.; }
      bool   is_known() const { return tau > 0. && eps > 0.; }
    };

    FrozenVelocity frozen_velocity(const Model &m, const double end_time)
    {
      FrozenVelocity result;
      double         mass = 0., volume = 0.;
      for (std::size_t i = 0; i < m.grains.n(); ++i)
        if (!std::isinf(m.grains.mass[i]))
          {
            mass += m.grains.mass[i];
            volume += grains::disc_volume(m.grains.fluid_radius[i]);
          }
      if (!(mass > 0.))
        return result;
      // that of the bed; of grains here and there, where there are most
      const double in_bed = find_scene_numbers(m, end_time).eps;
      result.eps          = in_bed < 1. ? in_bed : m.coupling.report().eps_min;
      result.tau =
        coupling::HomogeneousBed{m.grains, m.solver.properties, result.eps}.relaxation_time(m.coupling.drag_law());
      result.r             = (1. - result.eps) / result.eps * m.solver.properties.density * volume / mass;
      result.density_ratio = mass / volume / m.solver.properties.density;
      return result;
    }

    bool has_limit(const Model &m)
    {
      return m.has_fluid && m.grains_move && m.coupling.keeps_grain_velocity();
    }
  } // namespace


  double stable_step(const Model &m, const double end_time)
  {
    if (has_limit(m))
      if (const FrozenVelocity frozen = frozen_velocity(m, end_time); frozen.is_known())
        return frozen.limit();
    return std::numeric_limits<double>::infinity();
  }


  void check_time_step(Model &m, const double end_time)
  {
    if (!has_limit(m))
      return;
    const FrozenVelocity frozen = frozen_velocity(m, end_time);
    if (!frozen.is_known() || m.time_step < frozen.limit())
      return;
    std::ostringstream text;
    text.precision(2);
    text << "Coupling/Time scheme = " << m.coupling.scheme_name() << ": grains of void fraction " << frozen.eps;
    if (frozen.r >= 1.)
      text << " and " << frozen.density_ratio << " times the fluid's density are unstable with it at any time step";
    else
      text << " are unstable with it at time steps above " << frozen.limit()
           << " s, 2 eps^2 (1 - r) tau_p, and this one is " << m.time_step << " s";
    text << "; the default, iterated, has no such limit";
    m.warnings.add(text.str(), m.time);
  }
} // namespace alluvium::run
