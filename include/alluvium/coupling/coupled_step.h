#pragma once

#include <alluvium/coupling/contact_iteration.h>

#include <functional>

namespace alluvium::coupling
{
  /**
   * The order of a step of fluid and grains (section 2.3 of the paper), for programs, tests and benchmarks: the fluid
   * with the velocities that the grains are going to have, then the grains with what it gave them, and both again where
   * the time scheme asks for it. prepare() comes first; between it and step() the latest step can still be looked at.
   */
  class CoupledStep
  {
  public:
    /** From when, and how far. */
    struct Interval
    {
      double                time, dt;      // [s]
      std::array<double, 2> gravity;       // [m/s^2]
      bool                  fixed = false; // grains stay where they are
    };

    CoupledStep(fluid::VansSolver<2> &solver, Coupling &coupling, contacts::ContactStepper &contacts, Timers &timers);

    /** The fluid that the latest step has found is what the next one begins from. */
    void prepare();

    /**
     * Solve the fluid, and move the grains unless they are fixed. @p boundary_conditions are at the end of the
     * interval; @p touched says of each grain whether it had a contact in the step before (ContactStepper::touched());
     * @p loads and @p report become those of this step. @p accepts is asked when the fluid is solved: false ends the
     * step there, with the grains as they were. Returns whether the step was taken. Collective.
     */
    bool step(
      const fluid::BoundaryConditions<2> &boundary_conditions,
      const Interval                     &interval,
      const std::vector<std::uint8_t>    &touched,
      grains::GrainArrays                &grains,
      grains::GrainLoads                 &loads,
      contacts::ContactReport            &report,
      const std::function<bool()>        &accepts = [] { return true; });

    /** How fluid and contacts came to agree in the latest step. */
    const ContactIteration &iteration() const { return contact_iteration; }
    ContactIteration       &iteration() { return contact_iteration; }

  private:
    fluid::VansSolver<2>     &solver;
    Coupling                 &coupling;
    contacts::ContactStepper &contacts;
    Timers                   &timers;
    ContactIteration          contact_iteration;
  };
} // namespace alluvium::coupling
