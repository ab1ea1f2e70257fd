#pragma once

#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/coupling/coupling.h>

namespace alluvium::coupling
{
  /**
   * Moves the grains through a step whose fluid is solved. Where the time scheme repeats, and the velocities that the
   * fluid saw are not those that the grains take, the fluid is solved again with the motion that the grains took and
   * the grains start again from where they were, until both agree: in a jammed bed the contact forces of the last step
   * are not those of this one. The next guess is the combination of the motions so far that would make the disagreement
   * smallest (Anderson mixing). The end is also where that does not get smaller any more: it cannot where contacts are
   * solved loosely, as between fast grains. There the contacts of what is taken back are solved more loosely still.
   */
  class ContactIteration
  {
  public:
    /** @p timers get the phases "contacts" and, for what is repeated, "fluid". */
    ContactIteration(Coupling &coupling, contacts::ContactStepper &contacts, Timers &timers)
      : coupling(coupling)
      , contacts(contacts)
      , timers(timers)
    {}

    /**
     * After Coupling::step() with the same @p grains and @p dt [s]: move them under @p loads, which become those of the
     * last solve. @p gravity as for ContactStepper::advance(). Collective.
     */
    contacts::ContactReport
    advance(grains::GrainArrays &grains, grains::GrainLoads &loads, double dt, const std::array<double, 2> &gravity);

    /** How often the last step was repeated. */
    unsigned int n_iterations() const { return n; }
    /** Whether it ended within the time scheme's tolerance; true where that has none. */
    bool agrees() const { return agree; }

    /** Take each step as its first solve gives it, whatever the time scheme asks for. */
    void leave_out(const bool yes) { is_left_out = yes; }

    /**
     * If so, what the latest step leaves between fluid and grains: root mean square of Coupling::momentum_defect() over
     * the mean force on a grain.
     */
    double defect_left() const { return relative_defect; }

  private:
    /** What contacts make of the grains, and the forces that the fluid has not seen in it. */
    struct Attempt
    {
      contacts::ContactReport report;
      GrainMotion             motion;
      std::vector<double>     defect; // Coupling::momentum_defect()
    };

    Attempt move(grains::GrainArrays         &grains,
                 const grains::GrainLoads    &loads,
                 double                       dt,
                 const std::array<double, 2> &gravity,
                 double                       tolerance_factor);
    bool    agrees(const grains::GrainArrays &grains, const Attempt &attempt, double tolerance) const;

    Coupling                 &coupling;
    contacts::ContactStepper &contacts;
    Timers                   &timers;
    unsigned int              n     = 0;
    bool                      agree = true, is_left_out = false;
    double                    relative_defect = 0.;
  };
} // namespace alluvium::coupling
