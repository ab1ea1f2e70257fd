#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/run/check_time_step.h>
#include <alluvium/run/model.h>

#include <algorithm>
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

    FrozenVelocity frozen_velocity(const Model &m)
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
      // where they are dense it is that changes grow, and few are enough
      constexpr double densest = 0.1;
      result.eps               = coupling::void_fraction_of_densest(m.coupling, m.space, densest);
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


  double stable_step(const Model &m)
  {
    if (has_limit(m))
      if (const FrozenVelocity frozen = frozen_velocity(m); frozen.is_known())
        return frozen.limit();
    return std::numeric_limits<double>::infinity();
  }


  void check_time_step(Model &m)
  {
    // numbers differ from step to step, and the first ones tell enough
    const std::string kind = "Coupling/Time scheme = " + m.coupling.scheme_name() + ": ";
    const auto       &said = m.warnings.all();
    if (!has_limit(m) || std::any_of(said.begin(), said.end(), [&](const Warnings::Warning &warning) {
          return warning.text.compare(0, kind.size(), kind) == 0;
        }))
      return;
    const FrozenVelocity frozen = frozen_velocity(m);
    if (!frozen.is_known() || m.time_step < frozen.limit())
      return;
    std::ostringstream text;
    text.precision(2);
    const char *const where = ", that of the densest tenth of the grains";
    const char *const line  = " (the line in doc/lab/time-schemes): use iterated, which has no such limit";
    text << kind;
    if (frozen.r >= 1.)
      text << "it is unstable at any time step at void fraction " << frozen.eps << where
           << ", since this is below 1/(1 + s) = " << 1. / (1. + frozen.density_ratio)
           << " of grains of s = " << frozen.density_ratio << " times the fluid's density" << line;
    else
      text << "the time step of " << m.time_step << " s is " << m.time_step / frozen.limit()
           << " times its limit of stability at void fraction " << frozen.eps << where
           << ", 2 eps^2 (1 - r) tau_p = " << frozen.limit() << " s with r = " << frozen.r
           << " and tau_p = " << frozen.tau << " s" << line << ", or Time/Time step <= " << frozen.limit();
    m.warnings.add(text.str(), m.time);
  }


  void check_number_of_steps(Model &m, const double end_time)
  {
    constexpr double many   = 1e4;
    const double     stable = stable_step(m), n_steps = (end_time - m.time) / (stable_share * stable);
    if (!(n_steps > many) || stable == 0.)
      return;
    std::ostringstream text;
    text.precision(2);
    text << "Coupling/Time scheme = " << m.coupling.scheme_name() << " keeps chosen time steps below " << stable_share
         << " of its limit of stability, " << stable << " s with the grains as they are: about " << n_steps
         << " steps to Time/End time. Use iterated, which has no such limit.";
    m.warnings.add(text.str(), m.time);
  }
} // namespace alluvium::run
