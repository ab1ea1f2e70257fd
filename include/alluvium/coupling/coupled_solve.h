#pragma once

#include <alluvium/coupling/piece_drag.h>
#include <alluvium/coupling/time_scheme.h>
#include <alluvium/fluid/vans_solver.h>

namespace alluvium::coupling
{
  /** What linear solves have taken. */
  struct SolveCounts
  {
    unsigned int n_iterations = 0; // linear
    unsigned int n_loose      = 0; // solves that stopped above the tolerance
    unsigned int n_direct     = 0; // solves by the direct solver, after all else had failed

    void add(const SolveCounts &other);
  };

  /** Solves the fluid of a step with the exchange terms of its grains, as often as the time scheme wants. */
  class CoupledSolve
  {
  public:
    static constexpr int dim = 2;

    /** @p map is cut, @p eps is up to date, and both have their size, before the calls below. */
    CoupledSolve(const fluid::FluidSpace<dim> &space,
                 fluid::VansSolver<dim>       &solver,
                 OverlapMap                   &map,
                 const fluid::Vector          &eps);

    void add_parameters(dealii::ParameterHandler &prm);
    void parse_parameters() { drag.parse_parameters(); }

    /** The space has been rebuilt. */
    void reinit();

    /** Find the fluid of t^n at all pieces of @p state, their drag and, where it is on, their added mass. */
    void prepare(CouplingState &state);

    /** Find the added mass's terms anew, for another time step; there are none where it is off. */
    void find_acceleration(CouplingState &state) const;

    /**
     * Solve @p problem, of which void fraction, pieces and reference fields are set here. Afterwards the fluid is in
     * @p state and in the solver. Collective.
     */
    SolveCounts solve(const fluid::BoundaryConditions<dim> &boundary_conditions,
                      const TimeScheme                     &scheme,
                      fluid::VansProblem<dim>               problem,
                      CouplingState                        &state);

    /**
     * Solve the same once more with state.corrected_motion, and with the combination of all solutions so far with
     * @p weights, the oldest first, as that of the latest solve. Collective.
     */
    SolveCounts solve_again(const TimeScheme &scheme, const std::vector<double> &weights, CouplingState &state);

    bool   couples_rotation() const { return rotation; }
    double added_mass_coefficient() const { return added_mass; }

    PieceDrag drag;

  private:
    void        sample_fields(const fluid::BlockVector &field, CouplingState &state) const;
    SolveCounts latest_counts() const;

    const fluid::FluidSpace<dim> *space;
    fluid::VansSolver<dim>       *solver;
    OverlapMap                   *map;
    const fluid::Vector          *eps;
    double                        added_mass = 0.;
    bool                          rotation   = false;

    fluid::BlockVector              reference_field; // that of the latest solve, to which exchange terms refer
    std::vector<fluid::BlockVector> solutions;       // that a repeated solve is made of
  };
} // namespace alluvium::coupling
