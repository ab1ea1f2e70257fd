#pragma once

#include <alluvium/fluid/driving.h>
#include <alluvium/fluid/given_velocity.h>
#include <alluvium/fluid/linear_solver.h>
#include <alluvium/fluid/vans_assembler.h>
#include <alluvium/utilities/timers.h>

namespace alluvium::fluid
{
  /**
   * One time step of the volume-averaged Navier-Stokes equations, cut where the coupling needs it: begin_step() takes
   * the boundary values of the new time, solve() assembles and solves, solve_again() changes only the pieces' known
   * terms.
   */
  template <int dim>
  class VansSolver
  {
  public:
    explicit VansSolver(const FluidSpace<dim> &space);

    void add_parameters(dealii::ParameterHandler &prm);

    /** Forget matrices and preconditioner: the space has been rebuilt. @p solution and old() are zero afterwards. */
    void reinit();

    /**
     * Start the step from t^n to t^n + dt; the boundary conditions' time is already the new one. @p problem's pointers
     * must stay valid until the step is over; its `old` is set here.
     */
    void begin_step(const BoundaryConditions<dim> &boundary_conditions, const VansProblem<dim> &problem);

    /** Has the solution already the boundary values and the driving of the new time, to the last bit? Collective. */
    bool has_boundary_values(const BoundaryConditions<dim> &boundary_conditions, const Vector &void_fraction);

    /**
     * Flux out of the domain that each boundary with a given velocity has at the time of @p boundary_conditions
     * [m^2/s]. Throws UserError if one of their values, velocity or pressure, is not finite. Collective.
     */
    std::map<dealii::types::boundary_id, double> given_fluxes(const BoundaryConditions<dim> &boundary_conditions,
                                                              const Vector                  &void_fraction);

    /** Parse what drives the fluid, after the parameters; see Driving::initialize(). */
    void initialize_driving(const std::map<std::string, double> &constants)
    {
      driving.initialize(constants, space->periodic_box().length);
    }

    /** See Driving::functions_of_time(). */
    std::vector<FunctionOfTime> driving_functions() const { return driving.functions_of_time(); }

    /** Gradient of the pressure that the solution leaves out, datum() aside [Pa/m]; at the time of the latest step. */
    dealii::Tensor<1, dim> background_gradient() const
    {
      return driving.background_gradient(properties.density * gravity, space->periodic_box().length);
    }

    /** Weight of displaced fluid that no pressure gradient carries: rho g - background_gradient() [N/m^3]. */
    dealii::Tensor<1, dim> unsupported_weight() const { return properties.density * gravity - background_gradient(); }

    /** Assemble and solve with the pieces' present known terms. */
    void solve();

    /** Exchange the pieces' known terms without a new matrix: @p change_terms edits them and the reference fields. */
    template <typename Function>
    void solve_again(const Function &change_terms)
    {
      change_terms(current);
      solve_with_new_known_terms();
    }

    /** Start of the next step: u^n <- u^{n+1}. Until then flux() and interphase_force() belong to the last one. */
    void accept();

    /** Before accept(): the latest step is to be solved once more, from u^n, with another length. */
    void take_back();

    /**
     * Outflow of the mixture through a boundary with the latest solution and terms [m^2/s]. Where the velocity is given
     * that is what the continuity equation was given. Collective.
     */
    double flux(const dealii::types::boundary_id id) const
    {
      const auto it = boundary_fluxes.find(id);
      return it == boundary_fluxes.end() ? assembler.flux(current, iterate, id) : it->second;
    }

    /** What the fluid received from the pieces in the latest solve [N/m]. */
    std::array<double, dim> interphase_force() const { return assembler.interphase_force(current, iterate); }

    /** The moment of that about the origin [N]. */
    double interphase_torque() const { return assembler.interphase_torque(current, iterate); }

    const BlockVector &solution() const { return iterate; }
    const BlockVector &old() const { return previous; }
    /** For transfer, restart and initial values; the caller sets ghosts. */
    BlockVector &old() { return previous; }
    void         set_solution(const BlockVector &field);

    /** The latest problem: valid, as all it points to, until the next step or mesh change. */
    const VansProblem<dim> &problem() const { return current; }

    const LinearSolverReport &last_report() const { return report; }

    /**
     * Choose the pressure's datum from the boundary conditions at the start of a run; total pressure = reduced pressure
     * + rho g.x + datum(). A restart takes that of the interrupted run.
     */
    void   choose_datum(const BoundaryConditions<dim> &boundary_conditions);
    void   set_datum(const double value) { pressure_datum = value; }
    double datum() const { return pressure_datum; }

    /** What the solver keeps from step to step besides the fields; see LinearSolver. After the fields are loaded. */
    void save_history(ByteWriter &writer) const;
    void load_history(ByteReader &reader);

  private:
    VansAssembler<dim>
      assembler; // before the linear solver, whose smoothers look at the matrix when they are destroyed

  public:
    FluidProperties        properties;
    dealii::Tensor<1, dim> gravity;
    Discretisation         discretisation;
    LinearSolver           linear_solver;
    Timers                 timers; // phases "fluid: ..."

  private:
    /** What given total pressures are above static ones, with the flow that the step starts from. Collective. */
    std::map<dealii::types::boundary_id, double> pressure_deficits(const BoundaryConditions<dim> &boundary_conditions,
                                                                   const BlockVector             &start) const;

    /** Find given velocities and driving at the time of @p boundary_conditions. */
    void update_given(const BoundaryConditions<dim> &boundary_conditions, const Vector &void_fraction);

    /** Force on the fluid that is not on grains, per volume of fluid [N/m^3]. */
    std::array<double, dim> drive() const;

    void                  solve_with_new_known_terms();
    void                  solve_increment();
    std::array<double, 2> term_scale() const;

    /** The same, of the present iterate alone. Collective. */
    std::array<double, 2> term_sizes() const;

    /** Side of a cell, about [m]. Collective. */
    double cell_length() const;

    const FluidSpace<dim>       *space;
    VansProblem<dim>             current;
    std::unique_ptr<BlockVector> given_inertia; // that of the latest problem: it is looked at after the solve, too
    GivenVelocity<dim>           given;
    Driving<dim>                 driving;
    dealii::Tensor<1, dim>       latest_gradient;   // the background's in the latest step
    bool                         has_begun = false; // a step

    std::map<dealii::types::boundary_id, double> boundary_fluxes; // of the latest step
    BlockVector                                  iterate, previous, residual, known, increment, product;
    LinearSolverReport                           report;
    double                                       dt_of_preconditioner = 0., pressure_datum = 0.;
  };
} // namespace alluvium::fluid
