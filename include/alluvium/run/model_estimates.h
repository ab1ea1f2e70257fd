#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace alluvium::run
{
  /** The parts of the model that a scene may do without. */
  enum class Term
  {
    fluid,
    convection,
    inertia,
    viscous_stress,
    two_way_coupling,
    coupled_rotation,
    added_mass,
    iteration,
    adaptivity,
    contacts,
    friction,
    rotation,
    substeps
  };

  constexpr std::array<Term, 13> all_terms = {{Term::fluid,
                                               Term::convection,
                                               Term::inertia,
                                               Term::viscous_stress,
                                               Term::two_way_coupling,
                                               Term::coupled_rotation,
                                               Term::added_mass,
                                               Term::iteration,
                                               Term::adaptivity,
                                               Term::contacts,
                                               Term::friction,
                                               Term::rotation,
                                               Term::substeps}};

  /** As reports, parameters and the summary call it. */
  std::string name_of(Term term);

  /** A scene in the numbers that its terms are estimated from; SI units. */
  struct SceneScales
  {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    double dt = 1e-3;

    // fluid
    bool   has_fluid = true, convection = true, inertia = true, viscous_stress = true; // as asked for
    bool   is_driven = false; // by pressures, velocities, forces, or walls that move
    double density = 1000., viscosity = 1e-3;
    double velocity        = 0.;       // between grains, the largest to be expected
    double width           = 0.;       // of the domain, the smaller of its sides
    double driving_time    = infinity; // in which pressures and velocities on boundaries, and forces, change
    double first_row       = 0.;       // when the flow is first looked at
    bool   in_layers       = false; // fixed grains from side to side, the flow goes across them, and no wall holds it
    bool   has_clear_fluid = true;  // where there are no grains
    bool   has_no_slip     = false;
    double bed_height = 0., clear_height = 0., permeability = 0., eps = 1., smallest_eps = 1.;

    // grains
    bool   has_grains = true, grains_move = true, is_suspension = false;
    double diameter = 0., density_ratio = 0., packing = 0.;
    double settling_speed = 0., drag_of_fall = infinity; // drag over weight at the speed of a fall through the domain
    double added_mass       = 0.;                        // coefficient
    bool   couples_rotation = false, iterates = false;
    bool   mesh_follows = false, mesh_asks_grains_alone = false;

    // contacts
    bool   rotates      = true;
    bool   may_be_apart = true;     // no cohesion, no soft spheres, no walls that move
    double gap          = infinity; // the smallest
    double friction     = 0.;       // the largest coefficient
    double largest_move = 0.25;     // in a sub-step, in diameters
  };

  /** What became of a term, and why. */
  struct TermEstimate
  {
    Term        term;
    bool        on = true, is_asked = true;
    double      estimate = std::numeric_limits<double>::quiet_NaN(); // relative change without it; NaN: none is made
    std::string because  = {};
  };

  /**
   * All terms of a scene: off where leaving them out is estimated to change results by less than @p bound, or where
   * they are not asked for. @p keep stay on. Estimates rather say too much than too little. In the order of all_terms.
   */
  std::vector<TermEstimate> estimate_terms(const SceneScales &scene, double bound, const std::vector<Term> &keep = {});

  /**
   * What a step without iteration of fluid and contacts does to the places of grains, in diameters: @p defect, the
   * force that the fluid has not seen over the mean force on a grain, times the path in a step at @p speed [m/s].
   */
  double iteration_estimate(double defect, double speed, double dt, double diameter);

  /** Below 0.5 a step that is not iterated may be unstable (doc/theory/coupling.md); this leaves some room. */
  constexpr double least_eps_without_iteration = 0.55;
} // namespace alluvium::run
