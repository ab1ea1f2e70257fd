#pragma once

#include <alluvium/contacts/contact_active_set.h>
#include <alluvium/contacts/contact_bodies.h>
#include <alluvium/contacts/contact_bonds.h>
#include <alluvium/contacts/contact_motion.h>
#include <alluvium/contacts/contact_report.h>
#include <alluvium/contacts/contact_scales.h>
#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/contacts/laws/contact_material.h>
#include <alluvium/contacts/laws/contact_settings.h>
#include <alluvium/contacts/ranks/local_contact_problem.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/moment_correction.h>

#include <limits>
#include <vector>

namespace alluvium::contacts
{
  /** Takes the sub-steps of a contact step: one solve, perhaps a second one, or two halves. */
  class ContactSubstep
  {
  public:
    /** What stays the same in all sub-steps of a step. */
    struct Step
    {
      ContactScales        scales;
      ContactMaterials     materials;
      const ContactSolver *solver           = nullptr;
      const Cohesion      *cohesion         = nullptr; // none
      double               base_h           = 0.;      // length of an unhalved sub-step [s]
      double               tolerance_factor = 1.;      // where grains move, tolerances are this much larger
    };

    ContactSubstep(const ContactSettings &settings, LocalContactProblem &local)
      : settings(settings)
      , local(local)
    {}

    void begin(Step new_step);

    /** One unhalved sub-step. Collective, as all of this. */
    void advance(ContactReport &report) { advance(step.base_h, 0, report); }

    /** Fill what @p report says of the end of the step. */
    void finish(ContactReport &report);

    /** See ContactMotion. */
    const std::vector<std::array<double, 3>> &wall_impulses() const { return motion.wall_impulses(); }

  private:
    /** What a solve came to. */
    struct Outcome
    {
      ContactSolution solution;
      double          largest_impulse = 0.;                                       // normal, on this rank [N s/m]
      double          speed           = 0.;                                       // of the fastest grain [m/s]
      double          smooth          = std::numeric_limits<double>::quiet_NaN(); // see ContactReport
      bool            too_far         = false;                                    // it moves farther than it may
    };

    const ContactSettings &settings;
    LocalContactProblem   &local;
    Step                   step;

    // Of the sub-step
    ContactProblem      problem;
    ContactBodies       bodies;
    ContactActiveSet    active;
    ContactBonds        bonds;
    ContactMargins      margins;
    double              slack = 0.; // how far two grains may approach before a pair is missed [m]
    MomentCorrection    moments;
    std::vector<double> weight; // what the loads give each grain along gravity [N s/m]

    ContactMotion motion;

    void             advance(double h, unsigned int level, ContactReport &report);
    void             set_margins(double h);
    double           with_margin(double needed, double at_rest) const;
    void             search_if_due();
    void             set_problem(bool keep);
    ContactTolerance tolerance(bool on_the_move) const;
    Outcome          solve(ContactReport &report, bool may_halve);
    void             look_for_crushed(ContactReport &report) const;
    bool             misses_contacts(const std::array<double, 2> &speeds);
    void             find_weights();
  };
} // namespace alluvium::contacts
