#pragma once

#include <alluvium/run/divergence_monitor.h>
#include <alluvium/run/good_state.h>
#include <alluvium/run/output.h>
#include <alluvium/run/places.h>
#include <alluvium/run/step_measures.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/failure.h>

#include <chrono>
#include <functional>
#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::run
{
  /**
   * What surrounds the steps of a run: judges each of them, keeps checkpoints of good ones, and writes down how the run
   * ended, however it did.
   */
  class RunGuard
  {
  public:
    RunGuard(Model &model, Output &output)
      : model(model)
      , output(output)
    {}
    ~RunGuard();

    void add_parameters(dealii::ParameterHandler &prm);

    /** Once the output folder is ours: from here on fail() works. @p is_restart: it has a checkpoint. Collective. */
    void begin(bool is_restart);

    /** Go on from the @p state of a checkpoint. */
    void resume(const nlohmann::ordered_json &state);

    /** Before the first step. Collective. */
    void start();

    /** The mesh is going to change in this step, and has changed. Collective. */
    void before_mesh_change() { good.forget(); }
    void after_mesh_change();

    /** Grains have been taken out before a step. Collective. */
    void after_removal();

    /** Energy is measured from now on as the equations have it that are solved now. */
    void after_model_change() { after_removal(); }

    /** Throw a Divergence if the step that the model has taken cannot be believed. Collective. */
    void judge();

    /** The same within a step, when its contacts are solved. Collective. */
    void judge_contacts();

    /** @p error, thrown within a step, with when and where. */
    Divergence with_place(const Divergence &error) const;

    /** Write a checkpoint if one is due, and keep the state if it is good. Collective. */
    void keep();

    /** Between two checkpoints [s]; 0: there are none before the end. */
    double interval_of_checkpoints() const { return interval; }

    /** Let @p save put what it remembers into each checkpoint, on the first rank. */
    void also_save(const std::function<void(nlohmann::ordered_json &)> &save) { save_more = save; }

    /** How the last step went, for the progress. */
    std::string state_in_words() const;

    /** The run has ended well, or by @p signal: checkpoint and summary. Collective. */
    void conclude(int signal);

    /** It has ended in @p failure: leave what can be left. Throws nothing. */
    void fail(const Failure &failure);

  private:
    void        raise(const Sign &sign, unsigned int step, double time);
    void        keep_good_state();
    void        write_checkpoint();
    void        write_good_state();
    void        write_provisional_summary();
    std::string headline(bool is_restart) const;
    /** For a checkpoint: libraries that write in parallel abort where there is none. Collective. */
    bool disk_has_room() const;

    Model            &model;
    Output           &output;
    StepMeter         meter;
    DivergenceMonitor monitor;
    GoodState         good;
    StepMeasures      measures;
    Place             fastest;              // grain when the last step had ended: a failed one leaves them under way
    double            interval        = 0.; // of checkpoints [s]
    bool              is_due          = false;
    bool              has_judged      = false; // that the step failed: the error has its place
    long              checkpoint_step = -1;    // of the one in the folder
    MPI_Comm          of_failures     = MPI_COMM_NULL;

    std::function<void(nlohmann::ordered_json &)> save_more = [](nlohmann::ordered_json &) {};

    std::chrono::steady_clock::time_point last_summary{};
  };
} // namespace alluvium::run
