#pragma once

#include <alluvium/grains/bed_packing.h>

#include <limits>
#include <string>

namespace alluvium::run
{
  struct Model;

  /** What a user wants to know of a scene before it runs. Zero where it has no meaning. */
  struct SceneNumbers
  {
    double             diameter = 0., radius_factor = 1.; // mean contact diameter [m]; fluid over contact radius
    grains::BedPacking bed;
    bool               is_suspension = false; // most of its grains touch nothing, and may move

    double eps                   = 1.; // of the bed as the fluid sees it
    double permeability          = 0.; // of the bed with its void fraction as it is in the run [m^2]
    double fluidisation_velocity = 0.; // superficial [m/s]
    double viscous_time          = 0.; // rho d^2/eta [s]

    double density_ratio     = 0.; // s: of the grains to the fluid, by the radius that mass follows
    double critical_gradient = 0.; // the bed's weight less buoyancy over rho g and its area
    double terzaghi          = 0.; // (s - 1)(1 - n), with the packing that the fluid sees

    double archimedes = 0., reynolds = 0., stokes = 0.; // the latter two at the terminal velocity
    double terminal_velocity = 0.;                      // of a grain alone [m/s]
    double shields_stress    = 0.;                      // (rho_p - rho) g d [Pa]

    bool        has_drag        = false;
    double      relaxation_time = 0.; // mass over drag in creeping flow, in the bed if there is one [s]
    double      velocity        = 0.; // the largest to be expected at least [m/s] ...
    std::string velocity_of;          // ... and where it is from
    double      courant = 0.;         // with that and the smallest cell

    double n_steps = 0., memory = 0.,
           time = 0.; // [-], [byte] of all ranks, [s]; the latter two within a factor of some
  };

  /** Of a run to @p end_time [s] by steps as they are now, or of @p longest_step [s] if that is shorter. Collective. */
  SceneNumbers find_scene_numbers(const Model &model,
                                  double       end_time,
                                  double       longest_step = std::numeric_limits<double>::infinity());

  /** Seconds, minutes, hours or days. */
  std::string duration_in_words(double seconds);
} // namespace alluvium::run
