#pragma once

#include <map>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::contacts
{
  /** The numbers of the contact laws and of their time stepping; the parameter file's defaults. */
  struct ContactSettings
  {
    double       friction            = 0.4;  // between grains
    double       wall_friction       = 0.4;  // between grains and walls
    double       rolling_friction    = 0.;   // between grains, and with walls
    double       restitution         = 0.;   // Newton's
    double       threshold_velocity  = 0.01; // [m/s] slower impacts do not bounce
    bool         hydrostatic_guess   = true;
    bool         rotation            = true;
    double       residual_tolerance  = 4e-5; // of mean weight times h, as the next
    double       violation_tolerance = 1e-2;
    double       smooth_tolerance    = 1e-3; // of g h
    bool         moment_correction   = true;
    bool         halve_stalled       = false;
    double       stagnation_factor   = 100.; // both grow up to this factor ...
    unsigned int stagnation_sweeps   = 30;   // ... after so many sweeps, ten times as many unless grains move ...
    double       moving_speed        = 0.1;  // ... faster than this, root mean square, times g dt
    unsigned int max_sweeps          = 3000;
    unsigned int max_halvings        = 4;
    double       max_move            = 0.25; // of the smallest diameter, in one sub-step
    double       dead_zone           = 5e-4; // times dt sqrt(g d)
    double       correction          = 0.2;  // part of an overlap that one (unhalved) sub-step opens
    double       depenetration_speed = 0.1;  // times sqrt(g d): and how fast at most
    unsigned int rest_steps          = 10;   // without change before grains sleep; see Rest
    double       skin                = 0.15; // of the largest diameter
    unsigned int least_grains_a_rank = 2000; // grains a rank, or every rank does all

    std::map<std::string, double> single_friction, single_rolling_friction, single_restitution; // of walls, by name

    /** Declare them in the current section of @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace alluvium::contacts
