#pragma once

#include <alluvium/coupling/coupled_solve.h>
#include <alluvium/coupling/drag_range_record.h>
#include <alluvium/coupling/grain_forces.h>

namespace alluvium::coupling
{
  /** What a step's exchange looked like; sums over all ranks. */
  struct CouplingReport
  {
    double                eps_min = 1., eps_max = 1.;
    double                clipped_volume  = 0.; // [m^2], see OverlapMap::void_fraction()
    std::array<double, 2> force_on_grains = {
      {0., 0.}}; // what the fluid gave the grains, weight of displaced fluid aside [N/m]
    std::array<double, 2> force_on_fluid = {{0., 0.}}; // what the fluid's equations received [N/m]; only from audit()
    double                force_scale    = 0.;         // sum of |force| over the grains [N/m]
    double                force_parts    = 0.; // sum of the sizes of what those are differences of [N/m]; from audit()
    double                force_outside_range = 0.; // of that, on those outside the range of the drag law [N/m]
    // with their moments about the origin, where rotation is coupled; the second only from audit() [N]
    double                torque_on_grains = 0., torque_on_fluid = 0.;
    std::array<double, 2> momentum_defect = {{0., 0.}}; // sum of Coupling::momentum_defect() [N/m]
    std::size_t           n_pieces        = 0;
    unsigned int          n_iterations    = 0; // linear, over all solves, and of reinitialise_flow() before the step
    bool                  steady          = false; // nothing had changed: all is that of the step before
    unsigned int          n_loose         = 0;     // solves that stopped above the tolerance
    unsigned int          n_direct        = 0;     // solves by the direct solver, after all else had failed
  };

  /**
   * One coupled fluid step: cut the grains, find the void fraction and the drag, solve the fluid with the grains'
   * predicted velocities, and give the loads to the grains.
   */
  class Coupling
  {
  public:
    static constexpr int dim = 2;

    Coupling(const fluid::FluidSpace<dim> &space, fluid::VansSolver<dim> &solver);

    void add_parameters(dealii::ParameterHandler &prm);
    /** Check what the parameter handler's patterns cannot. */
    void parse_parameters();

    /** Grains have been taken out of the arrays: @p keep says which stay. Before the next step(). */
    void remove_grains(const std::vector<std::uint8_t> &keep);

    /** The space has been rebuilt. */
    void reinit();

    /** Cut @p grains and find the void fraction; step() does it by itself. Returns whether they moved. */
    bool update_void_fraction(const grains::GrainArrays &grains);

    /** How far from its centre a grain of @p diameter is spread [m]. */
    double reach(const double diameter) const
    {
      return settings.filter_radius > 0. ? settings.filter_radius * diameter : 0.5 * diameter;
    }

    /** Cut all grains anew in the next step, whether they moved or not. */
    void forget_positions() { map.forget_positions(); }

    /**
     * What the next step() of @p grains depends on besides the fluid's fields, and what the run remembers. load() cuts
     * the grains where they were cut last; it throws std::runtime_error if @p reader ends. Collective.
     */
    void save(ByteWriter                      &writer,
              const grains::GrainArrays       &grains,
              const std::vector<std::uint8_t> &touched,
              double                           dt,
              bool                             fixed) const;
    void load(ByteReader &reader, const grains::GrainArrays &grains);

    /**
     * Solve the fluid from t^n to t^n + @p dt and fill @p loads. @p boundary_conditions are at the new time. @p fixed
     * grains do not move. A step that would be the last one once more, bit by bit, is not computed.
     * Collective.
     */
    void step(const fluid::BoundaryConditions<dim> &boundary_conditions,
              const grains::GrainArrays            &grains,
              const std::vector<std::uint8_t>      &touched,
              const double                          dt,
              const bool                            fixed,
              grains::GrainLoads                   &loads);

    /**
     * The mesh has changed, and the fields were carried over: find those that have on it the acceleration that they
     * had, (solution - @p before)/@p dt, and so the same forces on the grains, which move with their velocities. What
     * interpolation left would pass for an acceleration in the next steps. Boundary conditions are at the present time.
     * That is for a flow that hardly changes in a step, through grains that hardly move: otherwise what changes in a
     * step would be taken for what the meshes differ in, many times over. Elsewhere the flow has only as long for it as
     * drag takes to bring grains and fluid together, and only its velocity is kept, which fulfils the continuity
     * equation of this mesh; the pressure stays as it was carried over. Nothing is done there if only a small @p share
     * of the domain's area has other cells than before. Returns whether a flow was found. Collective.
     */
    bool reinitialise_flow(const fluid::BoundaryConditions<dim> &boundary_conditions,
                           const grains::GrainArrays            &grains,
                           double                                dt,
                           const fluid::BlockVector             &before,
                           double                                share);

    TimeScheme::IterationLimit iteration_limit() const { return scheme_choice.get().iteration_limit(); }
    const std::string         &scheme_name() const { return scheme_choice.name(); }
    bool                       keeps_grain_velocity() const { return scheme_choice.get().keeps_grain_velocity(); }

    /**
     * Solve the latest step's fluid again with what the grains made of its loads, @p corrected, and what the fluid was
     * when they did: both are combinations of those of the solves so far, with @p weights, the oldest first. @p grains
     * are those of step(), where they were. Fills @p loads. Collective.
     */
    void repeat(const grains::GrainArrays &grains,
                const GrainMotion         &corrected,
                const std::vector<double> &weights,
                grains::GrainLoads        &loads);

    /**
     * Per grain, what it got from the fluid in the latest step less what the fluid gave it: the momentum defect between
     * the phases, as a force, x and y one after the other [N/m]. Where drag is implicit that is G (v* - v), because the
     * grain took another velocity than the fluid saw. @p before are the grains' velocities at the beginning of the step
     * [m/s], @p motion is what the loads made of them.
     */
    std::vector<double> momentum_defect(const grains::GrainArrays &grains,
                                        const grains::Components  &before,
                                        const GrainMotion         &motion,
                                        const grains::GrainLoads  &loads) const;
    /** The mean submerged weight of a grain, or the mean force of the fluid on one, whichever is larger [N/m]. */
    double typical_force(const grains::GrainArrays &grains) const;
    /** Put the sum of momentum_defect() into the report. */
    void set_momentum_defect(const std::vector<double> &of_grains);

    /** Complete the report with the sums that cost an assembly. */
    void audit();

    const CouplingReport &report() const { return last; }
    const fluid::Vector  &void_fraction() const { return eps; }
    const OverlapMap     &overlap() const { return map; }
    /** Force of the fluid on each grain in the last step, buoyancy of the hydrostatic pressure aside [N/m]; replicated.
     */
    const std::vector<std::array<double, 2>> &fluid_force() const { return forces.force(); }
    /** The velocity v* that the fluid saw, averaged over each grain's pieces [m/s]; replicated. */
    const std::vector<std::array<double, 2>> &predicted_velocity() const { return forces.velocity(); }
    /** The same piece by piece, of this rank [m/s]: pieces of a grain differ where solves have not converged. */
    std::vector<std::array<double, 2>> piece_velocities() const;
    const DragLaw                     &drag_law() const { return solve.drag.law(); }
    const std::string                 &drag_law_name() const { return solve.drag.law_name(); }
    /** Ids of the grains whose mean void fraction or Reynolds number has ever been outside the drag law's range. */
    std::vector<grains::GrainId> outside_drag_range(const grains::GrainArrays &grains) const
    {
      return outside_range.ids(grains);
    }

    /** The flow at the beginning of the latest step; ghosted. */
    const fluid::BlockVector &flow_before_step() const { return finds_stationary ? flow_before : solver->old(); }

    /** Solve the next step in any case: the equations are others. */
    void forget_steady() { is_steady = resumes = false; }

    double added_mass_coefficient() const { return solve.added_mass_coefficient(); }
    bool   couples_rotation() const { return solve.couples_rotation(); }

    OverlapSettings settings;

  private:
    /** All that a step depends on, besides the fluid's state, the pieces and the boundary values. */
    struct Inputs
    {
      double                           dt    = 0.;
      bool                             fixed = false;
      std::vector<std::vector<double>> of_grains;
      std::vector<std::uint8_t>        touched;

      bool operator==(const Inputs &other) const
      {
        return dt == other.dt && fixed == other.fixed && of_grains == other.of_grains && touched == other.touched;
      }
    };

    /** For grains whose velocity is known. */
    const TimeScheme &frozen_scheme() const { return scheme_choice.get("implicit drag"); }

    static Inputs
    inputs_of(const grains::GrainArrays &grains, const std::vector<std::uint8_t> &touched, double dt, bool fixed);

    /** The time step, or 0 where the flow does not depend on it: through fixed grains, without inertia. */
    double relevant_dt(const double dt, const bool fixed) const
    {
      return fixed && !solver->discretisation.inertia ? 0. : dt;
    }

    /**
     * Solve @p problem, which has no inertia, until drag and convection are those of the flow itself: @p to_the_end, so
     * that nothing changes any more, or, while boundaries change, to a relative residual of 1e-4. Returns whether
     * nothing will change. Collective.
     */
    bool find_stationary(const fluid::BoundaryConditions<dim> &boundary_conditions,
                         const TimeScheme                     &scheme,
                         fluid::VansProblem<dim>               problem,
                         bool                                  to_the_end,
                         CouplingState                        &state);

    void count(const SolveCounts &counts);
    void find_loads(const TimeScheme &scheme, const CouplingState &state, grains::GrainLoads &loads);

    const fluid::FluidSpace<dim> *space;
    fluid::VansSolver<dim>       *solver;
    OverlapParameters             overlap_parameters;
    PluginChoice<TimeScheme>      scheme_choice;

    OverlapMap      map;
    fluid::Vector   eps;
    CoupledSolve    solve;
    GrainForces     forces;
    DragRangeRecord outside_range;

    CouplingReport     last, of_void_fraction;
    SolveCounts        of_reinitialisation; // for the report of the step that follows
    Inputs             last_inputs;
    grains::GrainLoads last_loads;
    bool               is_steady        = false; // the last step left the fluid as it was
    bool               resumes          = false; // with a step that the uninterrupted run may not compute
    bool               has_step         = false; // since the grains were others
    bool               finds_stationary = false; // in the latest step, which then keeps where it began
    fluid::BlockVector flow_before;
    PieceState         pieces; // of the latest step
  };
} // namespace alluvium::coupling
