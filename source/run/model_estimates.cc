#include <alluvium/run/model_estimates.h>
#include <alluvium/utilities/constants.h>
#include <alluvium/utilities/digits.h>

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  namespace
  {
    /** A term that is left out if @p estimate is below @p bound. */
    TermEstimate estimated(const Term term, const double bound, const double estimate, const std::string &because)
    {
      return {term, !(estimate < bound), true, estimate, because};
    }

    /** A term without which nothing changes. */
    TermEstimate off(const Term term, const std::string &because)
    {
      return {term, false, true, 0., because};
    }

    /** A term that the parameters leave out. */
    TermEstimate not_asked(const Term         term,
                           const std::string &because,
                           const double       estimate = std::numeric_limits<double>::quiet_NaN())
    {
      return {term, false, false, estimate, because};
    }

    TermEstimate on(const Term term, const std::string &because)
    {
      return {term, true, true, std::numeric_limits<double>::quiet_NaN(), because};
    }

    /** How long the fluid goes on moving by itself [s]: until drag, or in clear fluid viscosity, has stopped it. */
    double relaxation_time(const SceneScales &s)
    {
      // across layers: rho du/dt in bed and clear fluid against eta eps u/K in the bed, at one flux
      if (s.in_layers)
        return s.density * s.permeability * (s.bed_height + s.eps * s.clear_height) /
               (s.viscosity * s.eps * s.bed_height);
      return s.density * s.width * s.width / (pi * pi * s.viscosity);
    }

    TermEstimate fluid(const SceneScales &s, const double bound)
    {
      if (!s.has_fluid)
        return not_asked(Term::fluid, "Fluid/Model = none");
      if (!s.has_grains)
        return on(Term::fluid, "there is nothing else");
      if (s.is_driven || !s.grains_move)
        return on(Term::fluid, "its flow is asked for");
      const double estimate = std::max(1. / std::max(s.density_ratio, 1e-300), s.drag_of_fall);
      return estimated(Term::fluid,
                       bound,
                       estimate,
                       "buoyancy 1/s = " + rounded(1. / s.density_ratio) + ", drag over weight " +
                         rounded(s.drag_of_fall) + " after a fall through the domain");
    }

    TermEstimate convection(const SceneScales &s, const double bound)
    {
      if (!s.convection)
        return not_asked(Term::convection, "Fluid/Convection = false");
      if (s.in_layers)
        return estimated(Term::convection,
                         bound,
                         s.density * s.velocity * s.permeability * (1. - s.eps * s.eps) /
                           (s.viscosity * s.eps * s.bed_height),
                         "what the flow's speed " + rounded(s.velocity) +
                           " m/s takes at the faces of the bed, over the pressure that drag takes in it");
      return estimated(Term::convection,
                       bound,
                       s.density * s.velocity * s.width / s.viscosity,
                       "Reynolds number of " + rounded(s.velocity) + " m/s in the width of the domain");
    }

    TermEstimate inertia(const SceneScales &s, const double bound)
    {
      if (!s.inertia)
        return not_asked(Term::inertia, "Fluid/Inertia = false");
      if (s.added_mass > 0.)
        return on(Term::inertia, "added mass needs the fluid's acceleration");
      const double time = relaxation_time(s);
      const double change =
        s.grains_move && s.velocity > 0. ? std::min(s.driving_time, s.width / s.velocity) : s.driving_time;
      // what is left of the start when the flow is first looked at, and how far it lags behind what changes
      const double estimate = std::exp(-s.first_row / time) + time / change;
      return estimated(Term::inertia,
                       bound,
                       estimate,
                       std::string(s.in_layers ? "drag" : "viscosity") + " stops the fluid in " + rounded(time) +
                         " s; it is looked at after " + rounded(s.first_row) + " s, and what drives it changes in " +
                         (std::isfinite(change) ? rounded(change) + " s" : "no time: it stays"));
    }

    TermEstimate viscous_stress(const SceneScales &s, const double bound)
    {
      if (!s.viscous_stress)
        return not_asked(Term::viscous_stress, "Fluid/Viscous stress = false");
      if (s.has_clear_fluid || s.grains_move || s.permeability == 0.)
        return on(Term::viscous_stress, "nothing else holds the fluid where there are no grains");
      const double darcy = s.permeability / (s.width * s.width);
      return estimated(Term::viscous_stress,
                       bound,
                       s.has_no_slip ? std::sqrt(darcy) : darcy,
                       "Darcy number " + rounded(darcy) + (s.has_no_slip ? ", its root at walls without slip" : ""));
    }

    TermEstimate added_mass(const SceneScales &s, const double bound)
    {
      const double s_or_one = s.density_ratio > 0. ? s.density_ratio : 1.;
      if (s.added_mass == 0.)
        return not_asked(Term::added_mass,
                         "not asked for (Coupling/Added mass coefficient); C_m = 1 would be this of a grain's mass",
                         1. / s_or_one);
      return estimated(Term::added_mass,
                       bound,
                       s.added_mass / s_or_one,
                       "C_m over the ratio of densities, " + rounded(s.density_ratio));
    }

    TermEstimate iteration(const SceneScales &s, const double bound)
    {
      if (!s.iterates)
        return not_asked(Term::iteration, "the time scheme has none (Coupling/Time scheme)");
      if (!s.grains_move)
        return off(Term::iteration, "Grains/Fixed = true");
      if (!s.is_suspension)
        return on(Term::iteration, "contact forces hold the grains, and change when they begin to move");
      if (s.density_ratio < 1.)
        return on(Term::iteration, "grains lighter than the fluid need it to be stable");
      if (s.smallest_eps < least_eps_without_iteration)
        return on(Term::iteration,
                  "stable without it only above a void fraction of " + rounded(least_eps_without_iteration));
      // in a step a grain comes to other fluid by its path over its diameter
      const double path = s.settling_speed * s.dt / s.diameter;
      return estimated(Term::iteration,
                       bound,
                       iteration_estimate(0.5 * std::sqrt(s.packing) * path, s.settling_speed, s.dt, s.diameter),
                       "grains go " + rounded(path) + " diameters in a step, packed " + rounded(s.packing) +
                         "; the first steps have it");
    }

    TermEstimate contacts(const SceneScales &s)
    {
      if (!s.grains_move)
        return off(Term::contacts, "Grains/Fixed = true");
      if (!s.may_be_apart)
        return on(Term::contacts, "cohesion, soft spheres or walls that move");
      constexpr double n_steps = 2.;
      const double     reach   = n_steps * 2. * s.settling_speed * s.dt;
      if (s.gap > reach)
        return off(Term::contacts, "nothing is nearer than " + rounded(s.gap / s.diameter) + " diameters; until it is");
      return on(Term::contacts, "grains touch, or may in the next step");
    }
  } // namespace


  std::string name_of(const Term term)
  {
    switch (term)
      {
        case Term::fluid:
          return "fluid";
        case Term::convection:
          return "convection";
        case Term::inertia:
          return "inertia of the fluid";
        case Term::viscous_stress:
          return "viscous stress of the mixture";
        case Term::two_way_coupling:
          return "two-way coupling";
        case Term::coupled_rotation:
          return "coupled rotation";
        case Term::added_mass:
          return "added mass";
        case Term::iteration:
          return "iteration of fluid and contacts";
        case Term::adaptivity:
          return "adaptivity";
        case Term::contacts:
          return "contacts";
        case Term::friction:
          return "friction";
        case Term::rotation:
          return "rotation of grains";
        case Term::substeps:
          return "sub-steps";
      }
    return "";
  }


  double iteration_estimate(const double defect, const double speed, const double dt, const double diameter)
  {
    return diameter > 0. ? defect * speed * dt / diameter : 0.;
  }


  std::vector<TermEstimate> estimate_terms(const SceneScales &s, const double bound, const std::vector<Term> &keep)
  {
    const auto keep_if_asked = [&](TermEstimate &t) {
      if (std::find(keep.begin(), keep.end(), t.term) == keep.end() || t.on || !t.is_asked)
        return;
      t.on      = true;
      t.because = "kept (Automatic model/Keep); " + t.because;
    };
    TermEstimate of_fluid = fluid(s, bound);
    keep_if_asked(of_fluid); // the other terms ask whether there is one
    std::vector<TermEstimate> terms = {of_fluid};
    if (of_fluid.on)
      {
        terms.push_back(convection(s, bound));
        terms.push_back(inertia(s, bound));
        terms.push_back(viscous_stress(s, bound));
        terms.push_back(s.has_grains ? on(Term::two_way_coupling, "a disc drags the fluid around it along")
                                     : off(Term::two_way_coupling, "there are no grains"));
        terms.push_back(s.couples_rotation && s.has_grains
                          ? on(Term::coupled_rotation, "asked for (Coupling/Rotation)")
                          : not_asked(Term::coupled_rotation, "not asked for (Coupling/Rotation)"));
        terms.push_back(added_mass(s, bound));
        terms.push_back(iteration(s, bound));
        terms.push_back(!s.mesh_follows ? off(Term::adaptivity, "the mesh stays as it is made")
                        : s.mesh_asks_grains_alone && !s.grains_move
                          ? off(Term::adaptivity, "the mesh follows grains, and these are fixed")
                          : on(Term::adaptivity, "the mesh follows what moves"));
      }
    else
      for (const Term term : all_terms)
        if (term > Term::fluid && term < Term::contacts)
          terms.push_back(off(term, "there is no fluid"));

    const bool has_grains = s.has_grains;
    terms.push_back(has_grains ? contacts(s) : off(Term::contacts, "there are no grains"));
    const bool touch = terms.back().on;
    terms.push_back(!touch             ? off(Term::friction, "nothing touches")
                    : s.friction == 0. ? not_asked(Term::friction, "its coefficients are 0", 0.)
                                       : on(Term::friction, "coefficient " + rounded(s.friction)));
    const bool turns = terms.back().on || (of_fluid.on && s.couples_rotation);
    terms.push_back(!s.rotates ? not_asked(Term::rotation, "Contacts/Grains rotate = false")
                    : turns    ? on(Term::rotation, "friction or the fluid turns the grains")
                               : off(Term::rotation, "nothing turns the grains"));
    const double path = s.diameter > 0. ? s.settling_speed * s.dt / (s.largest_move * s.diameter) : 0.;
    terms.push_back(
      !has_grains || !s.grains_move ? off(Term::substeps, "no grain moves")
      : path < 1. && s.settling_speed > 0.
        ? off(Term::substeps,
              "a step is " + rounded(path) + " sub-steps long at the speed of settling; each step is asked")
        : on(Term::substeps, "each step is asked"));
    for (TermEstimate &t : terms)
      keep_if_asked(t);
    return terms;
  }
} // namespace alluvium::run
