#include <alluvium/contacts/laws/contact_settings.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

namespace alluvium::contacts
{
  void ContactSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.add_parameter("Friction coefficient", friction, "Coulomb friction between grains [-].", Double(0.));
    prm.add_parameter(
      "Wall friction coefficient", wall_friction, "Coulomb friction between grains and walls [-].", Double(0.));
    prm.add_parameter("Friction of single walls",
                      single_friction,
                      "Coulomb friction of walls for which it is another, as `name: value, ...` [-].");
    prm.add_parameter(
      "Rolling friction coefficient",
      rolling_friction,
      "Rolling friction of grains and of grains with walls [-]: a moment of up to this times the normal "
      "force times the reduced radius r1 r2 / (r1 + r2), or the grain's radius at a wall, resists "
      "relative rotation. A disc stays where it is on a slope of up to this.",
      Double(0.));
    prm.add_parameter("Rolling friction of single walls",
                      single_rolling_friction,
                      "Rolling friction of walls for which it is another, as `name: value, ...` [-].");
    prm.add_parameter("Restitution",
                      restitution,
                      "Newton's coefficient of restitution [-]: 0, an impact ends the approach; 1, it turns it around.",
                      Double(0., 1.));
    prm.add_parameter("Restitution of single walls",
                      single_restitution,
                      "Restitution of walls for which it is another, as `name: value, ...` [-].");
    prm.add_parameter("Restitution threshold velocity",
                      threshold_velocity,
                      "Impacts slower than this do not bounce, so that grains come to rest [m/s].",
                      Double(0.));
    prm.add_parameter("Grains rotate", rotation, "If false, grains never spin, as if they were blocks.");
    prm.add_parameter(
      "Residual tolerance",
      residual_tolerance,
      "How far a contact impulse may be from its law, root mean square over all contacts, over the weight of one grain "
      "times the sub-step dt [-]: grains that touch move on one another with about this times g dt where they should "
      "not, at any depth. Without gravity the largest speed of a grain or a wall stands for g dt. With much more than "
      "1e-4 a loaded bed creeps and sinks, and costs more, not less. In sub-steps shorter than 0.2 sqrt(d/g) all "
      "tolerances are wider by the ratio, at most ten times: the speed at which the bed creeps is then the same. A "
      "sub-step is solved when this and `Largest violation` hold: where a few contacts are much worse than the others, "
      "as in impacts, the latter decides, and this one alone changes nothing.",
      Double(0.));
    prm.add_parameter(
      "Largest violation", violation_tolerance, "The same for the worst contact [-]; both must hold.", Double(0.));
    prm.add_parameter(
      "Moment correction",
      moment_correction,
      "Whether in beds of 1,000 grains and more that are at rest a few sums over large parts of the bed "
      "correct what sweeps hardly can: depth then costs nothing. Grains count as at rest if their root "
      "mean square speed is below 0.02 g dt, and only a smooth error that is most of the motion is "
      "corrected.");
    prm.add_parameter(
      "Smooth velocity tolerance",
      smooth_tolerance,
      "With the moment correction, the smooth part of the velocities that may be left in a bed at rest, "
      "root mean square, over g dt [-]. The residual does not see it: floor and sides of a bed that "
      "moves with 1e-3 g dt carry its weight within about 1e-3.",
      Double(0.));
    prm.add_parameter("Stagnation after sweeps",
                      stagnation_sweeps,
                      "After this many sweeps (ten times as many where the grains are not on the move) the tolerances "
                      "grow with the fourth power of the number of sweeps: where grains slide, a tight tolerance may "
                      "be out of reach, and there it matters less.",
                      Integer(1));
    prm.declare_alias("Stagnation after sweeps", "Patience");
    prm.add_parameter("Moving speed",
                      moving_speed,
                      "The grains are on the move if their root mean square speed is above this times g dt [-]. Where "
                      "they are not, a looser tolerance would let a loaded bed creep.",
                      Double(0.));
    prm.add_parameter("Stagnation tolerance factor",
                      stagnation_factor,
                      "The most by which the tolerances grow then [-]. 1: they never do.",
                      Double(1.));
    prm.declare_alias("Stagnation tolerance factor", "Loose factor");
    prm.add_parameter(
      "Largest number of sweeps",
      max_sweeps,
      "A sub-step that is not solved after this many sweeps is taken as two halves, unless it has stalled: where over "
      "the second half of the sweeps velocities have changed by less than 1e-2 of g dt, or of themselves, root mean "
      "square, halves would do no better.",
      Integer(1));
    prm.add_parameter("Halve stalled sub-steps", halve_stalled, "Whether to take them as two halves all the same.");
    prm.add_parameter(
      "Largest number of halvings",
      max_halvings,
      "How often a sub-step may be halved before its best solution is taken and reported as unconverged.",
      Integer(0, 20));
    prm.add_parameter(
      "Largest move per sub-step",
      max_move,
      "The fastest grain sets the sub-step: it moves at most by this fraction of the smallest diameter [-].",
      Double(1e-6, 1.));
    prm.add_parameter(
      "Dead zone",
      dead_zone,
      "Gaps and overlaps below this times dt sqrt(g d) count as closed [-], so that a bed at rest does not "
      "chatter: 1e-5 d at dt = 1e-4 s, 1e-4 d at 1e-3 s for sand of 0.2 mm. Never more than 1e-3 d.",
      Double(0.));
    prm.add_parameter(
      "Overlap correction",
      correction,
      "The part of an overlap that is opened in one sub-step [-], the error-reduction parameter. An overlap is an "
      "error of the solver or of the initial state, and opening it costs spurious velocity: small values cost less.",
      Double(0., 1.));
    prm.add_parameter(
      "Largest depenetration speed",
      depenetration_speed,
      "Overlaps that are there from the start open at most at this times sqrt(g d) [-], so that they do not explode.",
      Double(0.));
    prm.declare_alias("Largest depenetration speed", "Push-out speed");
    prm.add_parameter(
      "Hydrostatic initial guess",
      hydrostatic_guess,
      "Whether a bed whose contact impulses are not known yet starts from a hydrostatic guess, layer by "
      "layer, instead of from zero.");
    prm.declare_alias("Hydrostatic initial guess", "Cold start");
    prm.add_parameter("Steps to rest",
                      rest_steps,
                      "When over this many steps no load has changed by more than 1e-3 of a grain's weight and no "
                      "grain has moved by more than an acceleration of 4e-4 g would have moved it, the grains "
                      "sleep, and contacts are solved no more until something changes. 0: always solve.",
                      Integer(0));
    prm.add_parameter(
      "Search skin",
      skin,
      "Pairs nearer than this fraction of the largest diameter are remembered between contact searches [-]. Costs "
      "time; changes results only within the tolerance, by the order in which contacts are solved.",
      Double(1e-3));
    prm.add_parameter("Least grains a rank",
                      least_grains_a_rank,
                      "MPI ranks share the work of contacts if each gets this many grains; below, messages would cost "
                      "more than they save, and every rank does all. Results have the same bits either way.",
                      Integer(1));
  }
} // namespace alluvium::contacts
