#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <array>
#include <limits>
#include <map>
#include <string>

namespace alluvium::contacts
{
  /** Two that were found deep in one another in a sub-step that was not solved, or on the wrong side of each other. */
  struct Crush
  {
    double          depth = 0.; // over the smaller diameter; 0: there are none
    grains::GrainId a = 0, b = 0;
    std::string     wall;           // if that is the partner, in place of b
    bool            passed = false; // through it
  };

  /** What a contact step did. */
  struct ContactReport
  {
    std::map<std::string, std::array<double, 2>> wall_force; // mean force on each wall, by name [N/m]

    bool was_loosened =
      false; // grains moved, and tolerance_factor made the tolerance larger; see ContactStepper::advance()
    bool               at_rest       = false; // nothing was solved: loads and grains have not changed; see Rest
    unsigned int       n_quiet       = 0;     // steps without change up to now, this one included
    unsigned int       n_contacts    = 0;     // that carried an impulse in the last sub-step
    unsigned int       n_substeps    = 0;
    unsigned int       n_halvings    = 0; // sub-steps taken as two halves: no convergence, or grains moved too far
    unsigned int       n_loose       = 0; // solves that ended at the loose tolerance
    unsigned int       n_stalled     = 0; // sub-steps accepted above it, because more sweeps change nothing
    unsigned int       n_unconverged = 0; // sub-steps accepted above the tolerance, because halving did not help
    unsigned int       n_corrections = 0; // of moments; see MomentCorrection
    unsigned long long n_sweeps      = 0;
    unsigned long long n_updates     = 0; // contacts relaxed, over all sweeps

    double residual = 0., violation = 0.; // the largest of all sub-steps; see ContactTolerance
    /** The smooth velocity left at rest, over g dt, the largest of all sub-steps, or what it is below where all that
     * moves is within the tolerance; see MomentCorrection. Not a number where grains move, for less than 1,000 grains
     * and without gravity. */
    double smooth_velocity = std::numeric_limits<double>::quiet_NaN();
    double max_penetration = 0., mean_penetration = 0.; // over the overlapping contacts at the end [m]
    double max_velocity  = 0.;                          // of any grain at the end [m/s]
    double wall_work     = 0.;                          // of walls that move on the grains, in the step [J/m]
    double spring_energy = 0.;                          // of soft spheres, at the end [J/m]
    Crush  crush;                                       // the deepest of the step
  };
} // namespace alluvium::contacts
