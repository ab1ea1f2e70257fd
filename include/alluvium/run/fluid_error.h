#pragma once

#include <alluvium/fluid/vans_solver.h>

#include <algorithm>

namespace alluvium::run
{
  /**
   * How far a step of the fluid is from one of no length: the backward Euler method's local error dt^2 u''/2, with the
   * second derivative from the velocities of the last three times (Gresho, Griffiths and Silvester, SIAM J. Sci.
   * Comput. 30, 2008). It costs no solve.
   */
  class FluidError
  {
  public:
    /**
     * Before VansSolver::accept(): remember how the velocity changed in the last step, of @p dt [s]. With @p is_smooth
     * false it says nothing about the next one: a function that drives the flow has a kink between them, or the mesh
     * is another.
     */
    void begin(const fluid::VansSolver<2> &solver, double dt, bool is_smooth);

    /**
     * Of the step of @p dt [s] that was solved: root mean square over the domain, over the same of the velocity, of
     * a hundredth of the largest that the run has had, or over @p small_speed [m/s], whichever is largest. Zero where
     * begin() knew nothing. Collective.
     */
    double measure(const fluid::VansSolver<2> &solver, double dt, double small_speed);

    /** The step that was measured stays. */
    void accept() { largest = std::max(largest, speed); }

    double largest_speed() const { return largest; }
    void   set_largest_speed(const double speed) { largest = speed; }

  private:
    fluid::Vector change; // of the velocity in the last step [m/s]
    double        dt_before = 0., largest = 0., speed = 0.;
    bool          is_known = false;
  };
} // namespace alluvium::run
