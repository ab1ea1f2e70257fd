#pragma once

#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/coupling/coupled_step.h>
#include <alluvium/coupling/coupling.h>
#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/field_transfer.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/grains/grain_store.h>
#include <alluvium/mesh/domain.h>
#include <alluvium/observers/mesh_change.h>
#include <alluvium/observers/time_step_choice.h>
#include <alluvium/refinement/adaptivity.h>
#include <alluvium/run/grain_setup.h>
#include <alluvium/run/state.h>
#include <alluvium/utilities/timers.h>
#include <alluvium/utilities/warnings.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alluvium::run
{
  /**
   * What a run computes with: the rooms that take part, and the state that they advance. It decides nothing; set_up()
   * fills it, Simulation::Implementation::step() moves it on. The fluid's rooms stay empty in a dry scene.
   */
  struct Model : State
  {
    static constexpr int dim = 2;

    explicit Model(MPI_Comm communicator);

    /** Declare the parameters of all rooms in @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** What refinement criteria see of the grains, now. */
    refinement::RefinementContext refinement_context() const;

    /** Magnitude of the acceleration of gravity [m/s^2]. */
    double gravity_size() const;

    /** How heights are measured: along the axis nearest to gravity, y without it. */
    geometry::Upright upright() const { return geometry::Upright::of(gravity); }

    const MPI_Comm communicator;
    const bool     is_root; // this rank writes what the user reads

    // parameters
    double                time_step = 1e-3; // [s]
    bool                  has_fluid = true, grains_move = true;
    std::array<double, 2> gravity{}; // [m/s^2]

    // the rooms
    mesh::Domain<dim>                                domain;
    refinement::Adaptivity<dim>                      adaptivity;
    mesh::CellWeights                                cell_weights; // before the mesh, which asks it
    std::unique_ptr<dealii::Triangulation<dim, dim>> triangulation;
    fluid::BoundaryConditions<dim>                   boundary_conditions;
    fluid::FluidSpace<dim>                           space;
    fluid::VansSolver<dim>                           solver;
    coupling::Coupling                               coupling;
    run::GrainSetup                                  grain_setup;
    grains::GrainStore                               store;
    contacts::ContactStepper                         contacts;
    Timers                                           timers;
    Warnings                                         warnings;
    coupling::CoupledStep                            coupled_step;
    std::unique_ptr<fluid::FieldTransfer<dim>>       transfer;

    // of the latest step
    grains::GrainArrays    &grains = store.grains();
    grains::GrainLoads      loads;
    contacts::ContactReport contact_report;

    bool                                 watches_mesh_changes = false; // does an observer want to know of them?
    std::optional<observers::MeshChange> mesh_change;                  // the latest, if so

    std::optional<observers::TimeStepChoice> time_step_choice; // of the latest step, where the program chooses

    std::vector<std::string> accuracy; // what `Accuracy` has chosen, for the scene's report

    std::vector<std::pair<std::string, std::string>> parameters; // all of them as used; a checkpoint keeps them

    /** Forget what modules keep of earlier steps because it saves work: the next step finds it anew. Collective. */
    void drop_caches();

    /** Of all rooms, after the file was read; see Plugin. Throws UserError. */
    void parse_parameters();

  private:
    std::string gravity_text = "0, -9.81", fluid_model = "volume-averaged";
  };
} // namespace alluvium::run
