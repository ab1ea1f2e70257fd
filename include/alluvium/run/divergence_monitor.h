#pragma once

#include <alluvium/run/step_measures.h>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::run
{
  struct Model;

  /** By what sign a step has gone wrong, and where. */
  struct Sign
  {
    std::string           what; // empty: it has not
    double                value = 0., bound = 0.;
    std::string           unit;    // of both
    std::array<double, 2> point{}; // [m]
    std::string           near;    // the boundary or the grain there
    std::string           advice;
  };

  /**
   * Looks at every step and tells whether it can be believed. Energy is judged as a sum over steps: what the kinetic
   * energy has gained beyond its sources, less what it has lost since. Physics makes that sum zero; discretisation
   * leaves some percent of what flows through; where the flow runs away it becomes as large as the energy itself. That
   * energy is not the momentary one: where grains fly, gravity holds it for the time of their flight.
   */
  class DivergenceMonitor
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);

    /** Judge the step that @p model has taken. The same on all ranks; collective. */
    Sign judge(const Model &model, const StepMeasures &measures);

    /** Whether the last step was good beyond doubt: what a checkpoint may be made of. */
    bool is_calm() const { return calm; }

    /** Judge the contacts of a step that is not at its end: grains may be where they cannot be kept. */
    Sign judge_contacts(const Model &model) const;

    /** What to warn of, if grains overlap so much that contacts cannot be called hard; once. */
    std::string doubt_overlap(const Model &model);

    /** For checkpoints: what it remembers from step to step; of a checkpoint without that, nothing. */
    void save(nlohmann::ordered_json &state) const;
    void load(const nlohmann::ordered_json &state);

    /** The largest unexplained energy of a step, over the bound of its time. */
    double largest_share() const { return largest_share_of_bound; }

    /** Whether a sign ends the run; else it is a warning. */
    bool stops() const { return stop; }

  private:
    double noise(const Model &model) const;
    double kinetic_of_late(const Model &model, const StepMeasures &measures);
    Sign   judge_energy(const Model &model, const StepMeasures &measures);
    Sign   judge_penetration(const Model &model, double bound) const; // of depth over diameter [-]

    bool   stop                   = true;
    double largest_penetration    = 0.1;
    double unexplained            = 0.; // [J/m]
    double smallest_bound         = 0.; // of that, as there have been grains [J/m]
    double largest_share_of_bound = 0.;
    double of_late                = 0.; // kinetic energy that gravity may have stored [J/m]
    double flight                 = 0.; // for how long [s]
    double longest_step           = 0.; // [s]
    bool   calm                   = true;
    bool   overlap_was_doubted    = false;
  };

  /** What the user reads: what, where and in what step, that ended at @p time [s], by what sign, and what to try. */
  std::string in_words(const Sign &sign, unsigned int step, double time);
} // namespace alluvium::run
