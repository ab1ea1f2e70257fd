#pragma once

#include <alluvium/contacts/step_start.h>
#include <alluvium/observers/time_step_choice.h>
#include <alluvium/run/fluid_error.h>
#include <alluvium/run/pi_controller.h>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::run
{
  struct Model;

  /**
   * Chooses the time steps of a run. Fixed ones are as given, but for the last. With `Time step = auto` a step is as
   * long as the estimated errors of fluid and grains, the grains' path, the contacts and the time scheme's stability
   * let it be; it ends where output is due or a given function of time has a kink. A step that turns out too long is
   * taken back and repeated with a shorter one.
   *
   *   while (...)
   *     {
   *       (adapt the mesh)
   *       control.choose();
   *       do
   *         {
   *           control.begin();                           // remembers the state
   *           (fluid)
   *           if (!control.accepts_fluid()) continue;    // has taken it back
   *           (contacts)
   *         }
   *       while (!control.accepts_step());
   *     }
   */
  class TimeStepControl
  {
  public:
    explicit TimeStepControl(Model &model)
      : model(model)
    {}

    /** Declare its parameters and the time step's in section `Time`. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** After parsing: a step for the set-up of a run to @p end_time [s]. Throws UserError. */
    void parse_parameters(double end_time);

    bool automatic() const { return is_automatic; }

    /** In words, for the scene's report. */
    std::string description() const;

    /** The run goes to @p end_time, and wants steps to end at multiples of @p intervals (0: none; the first is that of
     * statistics) [s]. */
    void prepare(double end_time, const std::vector<double> &intervals);

    /** The length of the step that comes. Collective. */
    void choose();

    /**
     * Before its fluid is solved, each time: the fluid's last step is accepted. A mesh that @p mesh_has_changed for
     * this step is not taken back.
     */
    void begin(bool mesh_has_changed);

    /** When the step ends that begins [s]. */
    double end_of_step() const { return end_of_this; }

    /** Whether the fluid's step is good; else the model is as it was in begin(), with a shorter step. Collective. */
    bool accepts_fluid();

    /** Whether the grains' step is; as accepts_fluid(). The time is still that before the step. Collective. */
    bool accepts_step();

    /** The step has failed: take it back and make it shorter, or return false if it cannot be. Collective. */
    bool rescue();

    void save(nlohmann::ordered_json &state) const;
    void load(const nlohmann::ordered_json &state);

  private:
    struct Limit
    {
      const char *name;
      double      dt;
    };

    void   take_back(double factor, const char *reason);
    bool   may_be_shorter() const;
    void   set(double dt);
    double next_event(double time) const;
    double same_kink() const;
    double grain_error() const;
    double path_step() const;

    Model &model;

    // parameters
    std::string text      = "1e-3";
    double      tolerance = 5e-2, path = 0.5, largest = 0., smallest = 0.;

    bool                is_automatic = true;
    double              end_time     = 0.;
    std::vector<double> intervals, kinks;

    PiController              controller;
    FluidError                fluid_error;
    observers::TimeStepChoice coming; // the step that is being taken
    // [s]: if it is fixed; the next one, but for events; that before; the end of this one; the stability limit
    double fixed = 0., wanted = 0., dt_before = 0., end_of_this = 0., stable = 0.;
    double small_speed  = 0.;    // of the fluid: slower flow does not matter to grains [m/s]
    double fluid_defect = 0.;    // of this step, over the tolerance
    bool   has_history  = false; // of a step that was chosen
    bool   is_smooth = false, again = false;

    contacts::StepStart start; // what a step is taken back to
  };
} // namespace alluvium::run
