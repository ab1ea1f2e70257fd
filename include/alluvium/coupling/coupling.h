#pragma once

#include <alluvium/coupling/drag_law.h>
#include <alluvium/coupling/drag_regularisation.h>
#include <alluvium/coupling/time_scheme.h>
#include <alluvium/fluid/vans_solver.h>

#include <memory>

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
    double                force_outside_range = 0.;    // of that, on those outside the range of the drag law [N/m]
    // with their moments about the origin, where rotation is coupled; the second only from audit() [N]
    double                torque_on_grains = 0., torque_on_fluid = 0.;
    std::array<double, 2> unseen_force = {{0., 0.}}; // sum of Coupling::unseen_force() [N/m]
    std::size_t           n_pieces     = 0;
    unsigned int          n_iterations = 0;     // linear, over all sweeps, and of rebalance() before the step
    bool                  steady       = false; // nothing had changed: all is that of the step before
    unsigned int          n_loose      = 0;     // solves that stopped above the tolerance
    unsigned int          n_direct     = 0;     // solves by the direct solver, after all else had failed
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
     * grains neither move nor yield. A step that would be the last one once more, bit by bit, is not computed.
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
    bool rebalance(const fluid::BoundaryConditions<dim> &boundary_conditions,
                   const grains::GrainArrays            &grains,
                   double                                dt,
                   const fluid::BlockVector             &before,
                   double                                share);

    TimeScheme::Repetition repetition() const { return scheme_choice.get().repetition(); }
    const std::string     &scheme_name() const { return scheme_choice.name(); }
    bool                   keeps_grain_velocity() const { return scheme_choice.get().keeps_grain_velocity(); }

    /**
     * Solve the latest step's fluid again with what the grains made of its loads, @p answer, and what the fluid was
     * when they did: both are combinations of those of the solves so far, with @p weights, the oldest first. The grains
     * and contacts of step() must still be as they were. Fills @p loads. Collective.
     */
    void repeat(const GrainMotion &answer, const std::vector<double> &weights, grains::GrainLoads &loads);

    /**
     * Per grain, what it got from the fluid in the latest step less what the fluid gave it, x and y one after the
     * other [N/m]. Where drag is implicit that is G (v* - v), because the grain took another velocity than the fluid
     * saw. @p before are the grains' velocities at the beginning of the step [m/s], @p motion is what the loads
     * made of them.
     */
    std::vector<double>
    unseen_force(const grains::Components &before, const GrainMotion &motion, const grains::GrainLoads &loads) const;
    /** The mean reduced weight of a grain, or the mean force of the fluid on one, whichever is larger [N/m]. */
    double typical_force() const;
    /** Put the sum of unseen_force() into the report. */
    void set_unseen_force(const std::vector<double> &of_grains);

    /** Complete the report with the sums that cost an assembly. */
    void audit();

    const CouplingReport &report() const { return last; }
    const fluid::Vector  &void_fraction() const { return eps; }
    const OverlapMap     &overlap() const { return map; }
    /** Force of the fluid on each grain in the last step, buoyancy of the hydrostatic pressure aside [N/m]; replicated.
     */
    const std::vector<std::array<double, 2>> &fluid_force() const { return force; }
    /** The velocity v* that the fluid saw, averaged over each grain's pieces [m/s]; replicated. */
    const std::vector<std::array<double, 2>> &predicted_velocity() const { return predicted; }
    /** The same piece by piece, of this rank [m/s]: pieces of a grain differ where sweeps have not converged. */
    std::vector<std::array<double, 2>> piece_velocities() const;
    const DragLaw                     &drag_law() const { return drag_choice.get(); }
    const std::string                 &drag_law_name() const { return drag_choice.name(); }
    /** Ids of the grains whose mean void fraction or Reynolds number has ever been outside the drag law's range. */
    std::vector<grains::GrainId> outside_drag_range(const grains::GrainArrays &grains) const;

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

    void find_state(CouplingState &state);
    /** Mass of all grains over their drag: how fast it brings grains and fluid together [s]. */
    double relaxation_time(const CouplingState &state) const;
    void   find_loads(const TimeScheme &scheme, const CouplingState &state, grains::GrainLoads &loads);
    void   solve(const fluid::BoundaryConditions<dim> &boundary_conditions,
                 const TimeScheme                     &scheme,
                 fluid::VansProblem<dim>               problem,
                 CouplingState                        &state);
    void   find_drag(CouplingState &state);
    void   find_acceleration(CouplingState &state) const;
    void   look_at(const fluid::BlockVector &field, CouplingState &state) const;
    void   find_torques(const CouplingState &state, grains::GrainLoads &loads);
    /** From its grain to the image that was cut, for each piece [m]; with arms only. */
    std::vector<std::array<double, 2>> periodic_shifts(const CouplingState &state) const;
    void                               collect_forces(const CouplingState &state);

    /** Velocity of a piece as the fluid saw it in the latest sweep [m/s], and the force density on it [N/m^3]. */
    struct PieceForce
    {
      std::array<double, 2> velocity, force;
    };
    PieceForce piece_force(const CouplingState &state, const std::size_t k) const;

    const fluid::FluidSpace<dim>    *space;
    fluid::VansSolver<dim>          *solver;
    PluginChoice<DragLaw>            drag_choice;
    PluginChoice<TimeScheme>         scheme_choice;
    PluginChoice<DragRegularisation> regularisation_choice;
    OverlapParameters                overlap_parameters;
    double                           added_mass = 0.;
    bool                             rotation   = false;

    OverlapMap                         map;
    fluid::Vector                      eps;
    fluid::BlockVector                 latest_sweep;
    CouplingReport                     last, of_void_fraction;
    CouplingReport                     of_rebalance; // solves for the report of the step that follows
    Inputs                             last_inputs;
    grains::GrainLoads                 last_loads;
    bool                               still   = false; // the last step left the fluid as it was
    bool                               resumes = false; // with a step that the uninterrupted run may not compute
    std::unique_ptr<CouplingState>     latest_state;    // of the latest step; refers to its caller's grains
    std::vector<fluid::BlockVector>    repeated_with;   // the solutions that a repeated step is made of
    std::vector<std::array<double, 2>> force, predicted;
    std::vector<double>                drag_means; // sums over each grain's pieces on this rank: A eps, A Re
    std::vector<std::uint8_t>          outside;    // the drag law's range, at any time
  };
} // namespace alluvium::coupling
