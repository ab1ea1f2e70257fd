#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::fluid
{
  struct FluidProperties
  {
    double density   = 1000.; // [kg/m^3]
    double viscosity = 1e-3;  // dynamic [Pa s]
  };

  /** Terms on boundaries with a given pressure (doc/theory/open-boundaries.md); all are meant to be on. */
  struct OpenBoundaryTerms
  {
    bool traction   = true; // viscous traction eps eta du/dn alone, as in developed flow
    bool upwinding  = true; // streamline upwinding carries nothing across
    bool advection  = true; // where flow enters: developed, so without u.n du/dn
    bool tangential = true; // where flow enters: damped with eps rho |u.n|
    bool backflow   = true; // what comes back has the given pressure as its total pressure
  };

  /** Switches of the discretisation that charts compare. */
  struct Discretisation
  {
    bool lumped_drag = true; // row-sum lumping of the drag in the momentum equation
    bool convection  = true; // u.grad u and its stabilisation

    OpenBoundaryTerms open_boundary;
  };

  /**
   * One linearised VANS problem (paper (12)-(13)): its data at t^n and its known terms. All fields ghosted.
   */
  template <int dim>
  struct VansProblem
  {
    FluidProperties               fluid;
    Discretisation                discretisation;
    double                        dt;
    const Vector                 *void_fraction;              // nodal
    const BlockVector            *old;                        // u^n (block 0)
    const BlockVector            *inertia          = nullptr; // u of du/dt = (u^{n+1} - u)/dt where that is not u^n
    double                        stabilisation_dt = 0.;      // dt of tau where that is not dt [s]
    const InterphaseTerms<dim>   *solid;
    std::array<const Vector *, 3> reference = {{nullptr, nullptr, nullptr}}; // u_ref of the pieces; [0] stays null
    double                        tolerance_factor = 1.; // of the linear solver's tolerance, for this problem

    // set by the solver
    const BoundaryConditions<dim>            *boundary_conditions = nullptr;
    const std::vector<std::array<double, 2>> *given_fluxes        = nullptr; // GivenVelocity::face_fluxes()
    dealii::Tensor<1, dim> background_gradient; // of the pressure that the unknowns leave out [Pa/m],
    double                 pressure_datum = 0.; // and what it is at the origin [Pa]

    std::array<double, dim>      drive       = {};      // force on the fluid, not on grains [N/m^3 of fluid]
    const dealii::Function<dim> *body_force  = nullptr; // [N/m^3], dim components; for manufactured solutions
    const dealii::Function<dim> *mass_source = nullptr; // [1/s]
  };
} // namespace alluvium::fluid
