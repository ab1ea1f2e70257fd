#pragma once

#include <alluvium/coupling/declarations.h>
#include <alluvium/grains/bed_faces.h>
#include <alluvium/grains/leavers.h>
#include <alluvium/observers/mesh_change.h>
#include <alluvium/observers/time_step_choice.h>
#include <alluvium/output/statistics.h>
#include <alluvium/output/summary.h>
#include <alluvium/utilities/plugin.h>

#include <nlohmann/json_fwd.hpp>

#include <mpi.h>

#include <limits>
#include <string>
#include <vector>

// An observer includes what it looks at: coupling/coupling.h for the fluid, contacts/contact_stepper.h for the
// contacts.
namespace alluvium::contacts
{
  struct ContactReport;
  class ContactStepper;
} // namespace alluvium::contacts

namespace alluvium::grains
{
  struct WallSegment;
}

namespace alluvium::observers
{
  /** The fluid's side of a run, for those that look at it. */
  struct FluidView
  {
    const fluid::FluidSpace<2>         &space;
    const fluid::VansSolver<2>         &solver;
    const fluid::BoundaryConditions<2> &boundary_conditions;
    coupling::Coupling                 &coupling;

    /** Differential head [m], NaN where it has no meaning in this scene; see Output/Head between. */
    double head = std::numeric_limits<double>::quiet_NaN();

    /** Between the bottom and the top that the bed had at t = 0 (16)? Else between two boundaries, or nowhere. */
    bool head_of_bed = false;
    /** Does what flows from one open boundary to another cross the whole bed from below or from above? */
    bool crosses_bed = false;
  };

  /** What an observer sees after a step. The same on all ranks, apart from the fluid's distributed fields. */
  struct Snapshot
  {
    double                          time, dt; // [s]
    unsigned int                    step;
    const grains::GrainArrays      &grains;
    const grains::BedFaces         &initial_bed;
    double                          left, right; // of the domain, across gravity's axis [m]
    double                          bottom, top; // of the same in y [m]
    std::array<double, 2>           gravity;     // [m/s^2]
    const contacts::ContactReport  *contacts;    // null where grains do not move, and at t = 0
    const FluidView                *fluid;       // null in dry scenes
    const contacts::ContactStepper *stepper;     // null where grains do not move
    std::string                     folder;      // where output goes
    MPI_Comm                        communicator;
    const MeshChange               *mesh_change; // the latest, if watches_mesh_changes(); null before the first
    const grains::Leavers          &leavers;

    const std::vector<grains::WallSegment> &walls; // of the grains

    const TimeStepChoice *time_step_choice; // null where steps are given
  };

  /**
   * Interface of the plug-ins that measure. They may look at everything and change nothing; what they find goes into
   * the columns of statistics.csv and into summary.json.
   */
  class Observer : public Plugin
  {
  public:
    /**
     * Whether there is anything to measure in this scene; the others are never called again. Throws UserError for a
     * parameter that does not fit the scene, such as the name of a wall that it has not.
     */
    virtual bool applies(const Snapshot &) const { return true; }

    virtual void add_columns(const Snapshot &, output::Statistics &) {}

    /** Does it look at mesh changes? Measuring them costs a little, and is done only for those who do. */
    virtual bool watches_mesh_changes() const { return false; }

    /** Called after every step, and once before the first; collective. */
    virtual void observe(const Snapshot &) {}

    /** Fill this observer's columns of a row; after observe(), collective. */
    virtual void write(const Snapshot &, output::Statistics &) {}

    /** What the user came for. */
    virtual void conclude(output::Summary &) const {}

    /** What a restarted run must remember. */
    virtual void save(nlohmann::ordered_json &) const {}
    virtual void load(const nlohmann::ordered_json &) {}
  };
} // namespace alluvium::observers

/** Register an observer under the name that parameter files use. */
#define ALLUVIUM_REGISTER_OBSERVER(Class, name, prose)                                                                 \
  ALLUVIUM_REGISTER(::alluvium::observers::Observer, Class, name, prose)
