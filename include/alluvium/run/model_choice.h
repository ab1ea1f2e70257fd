#pragma once

#include <alluvium/run/model_estimates.h>

#include <nlohmann/json_fwd.hpp>

#include <limits>
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
   * `Model = auto`: leaves out at the start what is estimated to change results by less than a tenth of the accuracy
   * that is asked for, looks during the run at what it would have done, and switches a term on, for good, once that is
   * more. With `Model = full` it does nothing.
   *
   *   choose_fluid();   in set_up(), when grains are made and the fluid is not
   *   choose();         before the first step, when all is set up; or load() for a restart
   *   watch();          after each step
   */
  class ModelChoice
  {
  public:
    /** Of a run: until when, and when its rows are due, 0 for each step [s]; whether it chooses its time steps. */
    struct Schedule
    {
      double end_time, row_interval;
      bool   chooses_steps;
    };

    /** Declare `Model` and the section `Automatic model`. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** Throws UserError. */
    void parse_parameters();

    bool automatic() const { return is_automatic; }

    /** Take the fluid out of @p model if it need not be there. */
    void choose_fluid(Model &model);

    /** Estimate all terms and leave out what may be. Collective. */
    void choose(Model &model, const Schedule &schedule);

    /** Whether the mesh is still to be adapted: true with `Model = full`. */
    bool adapts() const { return is_on(Term::adaptivity); }

    /** A term that came on, and its line for the log. */
    struct Switch
    {
      Term        term;
      std::string text;
    };

    /** Estimate from the step that @p model has just taken what is left out, and switch on what has to be. Collective.
     */
    std::vector<Switch> watch(Model &model);

    /** A row for each term; empty with `Model = full`. */
    struct Row
    {
      TermEstimate term;
      double       since = std::numeric_limits<double>::quiet_NaN(); // if it was switched on in the run: when [s]
      double       most  = 0.; // the largest estimate of the run, while it was off
    };
    const std::vector<Row> &rows() const { return table; }

    /** The table as lines: `term | on or off | estimate | because`. */
    std::vector<std::string> in_words() const;

    void save(const Model &model, nlohmann::ordered_json &state) const;

    /** What load() will need of the fluid, before that is set up. Throws UserError if the parameters want another. */
    void load_fluid(const nlohmann::ordered_json &state, Model &model);

    /** Leave out what the interrupted run did. False if its grains were fixed and are free now, or the other way round:
     * then choose() again. */
    bool load(const nlohmann::ordered_json &state, Model &model);

  private:
    bool is_on(Term term) const;
    bool is_left_out(Term term) const; // though the parameters ask for it
    Row *row(Term term);
    void apply(Model &model) const;
    void switch_on(Term term, double estimate, const std::string &because, Model &model, std::vector<Switch> &switched);
    void watch_flow(Model &model, std::vector<Switch> &switched);

    // parameters
    std::string model_text = "full", keep_text;
    double      accuracy   = 0.01;

    bool              is_automatic = false, leaves_out_fluid = false;
    double            speed_when_looked_at = 0.; // norm of the flow's velocities when its terms were last estimated
    std::vector<Term> keep;
    std::vector<Row>  table;
  };

  /** @p model, whose fluid may not be set up yet, in the numbers that its terms are estimated from. Collective. */
  SceneScales find_scene_scales(Model &model, const ModelChoice::Schedule &schedule);
} // namespace alluvium::run
