#pragma once

#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/wall.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::grains
{
  /** The numbers of the contact laws and of their time stepping; the parameter file's defaults. */
  struct ContactSettings
  {
    double       friction            = 0.4;  // between grains
    double       wall_friction       = 0.4;  // between grains and walls
    double       restitution         = 0.;   // Newton's
    double       threshold_velocity  = 0.01; // [m/s] slower impacts do not bounce
    bool         rotation            = true;
    double       residual_tolerance  = 1e-5;
    double       violation_tolerance = 1e-3;
    double       loose               = 10.; // both times this ...
    unsigned int patience            = 100; // ... after so many sweeps
    unsigned int max_sweeps          = 3000;
    unsigned int max_halvings        = 4;
    double       max_move            = 0.25; // of the smallest diameter, in one sub-step
    double       dead_zone           = 5e-4; // times dt sqrt(g d)
    double       correction          = 0.2;  // part of an overlap that one (unhalved) sub-step opens
    double       push_out            = 0.1;  // times sqrt(g d): and how fast at most
    double       skin                = 0.15; // of the largest diameter
  };

  /** What a contact step did. */
  struct ContactReport
  {
    std::map<std::string, std::array<double, 2>> wall_force; // mean force on each wall, by name [N/m]

    unsigned int       n_contacts    = 0; // that carried an impulse in the last sub-step
    unsigned int       n_substeps    = 0;
    unsigned int       n_halvings    = 0; // sub-steps taken as two halves: no convergence, or grains moved too far
    unsigned int       n_loose       = 0; // solves that ended at the loose tolerance
    unsigned int       n_unconverged = 0; // sub-steps accepted above the tolerance, because halving did not help
    unsigned long long n_sweeps      = 0;
    unsigned long long n_updates     = 0; // contacts relaxed, over all sweeps

    double residual = 0., violation = 0.;               // the largest of all sub-steps; see ContactTolerance
    double max_penetration = 0., mean_penetration = 0.; // over the overlapping contacts at the end [m]
    double max_velocity = 0.;                           // of any grain at the end [m/s]
  };

  /** The contact impulses of the last sub-step: what makes the next one start warm. Part of a checkpoint. */
  struct ContactArchive
  {
    /** Grain @p a and grain @p b, or wall segment ~b (bits flipped) where `wall`. */
    struct Entry
    {
      GrainId a, b;
      bool    wall;
      double  rn, rt; // [N s/m]
    };
    double             dt = 0.; // of that sub-step [s]
    std::vector<Entry> entries;
  };

  /**
   * Moves the grains through one fluid step by non-smooth contact dynamics. Per sub-step of length h, with G the drag
   * coefficient of the loads,
   *
   *   m_e = m + h G        v_free = (m v + h f) / m_e        v = v_free + P / m_e        x += h v
   *
   * where the contact impulses P obey v_n + gap / h >= 0, Coulomb friction and Newton's restitution at the velocity
   * level. A grain's spin answers to its true inertia m r^2 / 2. A grain of infinite mass keeps its velocity.
   *
   * Runs on replicated arrays and communicates nothing: the same input gives the same bits. The result depends on the
   * grains and on the archived impulses, not on when the last contact search was.
   */
  class ContactStepper
  {
  public:
    ContactStepper();
    ~ContactStepper();

    /** Declare the parameters of contacts in the current section of @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    ContactSettings &settings();

    void                            set_walls(std::vector<WallSegment> walls);
    const std::vector<WallSegment> &walls() const; // where they are now, if they move

    /**
     * Advance positions, velocities and spins of @p grains by @p dt [s] under @p loads and contacts, and set their mean
     * contact force. @p gravity [m/s^2] only sets scales (it is part of the loads); without it the largest velocity
     * does. Throws std::runtime_error if a position or a velocity is not finite.
     */
    ContactReport advance(GrainArrays &grains, const GrainLoads &loads, double dt, std::array<double, 2> gravity);

    /** Whether each grain had a contact impulse in the last advance(); n() entries of 0 or 1. */
    const std::vector<std::uint8_t> &touched() const;

    ContactArchive archive() const;
    void           set_archive(ContactArchive archive);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium::grains
