#pragma once

#include <alluvium/scene/parameter_file.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace alluvium::scene
{
  /** Some parameters that are chosen together, for scenes of one kind and one value of `Accuracy`. */
  struct AccuracyChoice
  {
    std::string        kind;     // of scene, see AccuracyKind
    std::string        accuracy; // '10 %', '1 %', '0.1 %'
    std::string        group;    // 'cells', 'filter', 'time step', ...
    ParameterOverrides values;   // the first one leads: a scene with another value of it keeps the others' values, too
    std::string        reason;   // what was measured with all choices of this kind and accuracy
  };

  /** All choices, as `contrib/lab accuracy` has written them from what was measured. */
  const std::vector<AccuracyChoice> &accuracy_choices();

  /** Which of the measured scenes a scene is like. */
  struct AccuracyKind
  {
    std::string name;   // 'dry', 'bed': one with two faces that fluid goes through, 'suspension', 'other'
    std::string reason; // in words, for the scene's report
  };

  /** The kind of a scene whose parameters, 'Section/Name', have the values that @p value_of gives. */
  AccuracyKind find_accuracy_kind(const std::function<std::string(const std::string &)> &value_of);

  /** Declare the top-level parameter `Accuracy`. */
  void declare_accuracy(dealii::ParameterHandler &prm);

  /**
   * If @p statements ask for an accuracy, give the parameters that decide it the values that it takes in scenes of this
   * kind: to be called before they are applied. What a statement sets wins, and where it sets the first of a group to
   * something else, all of that group stays as it is. Returns what was chosen and why, in lines for the scene's report; none without `Accuracy`.
   */
  std::vector<std::string> apply_accuracy(dealii::ParameterHandler &prm, const std::vector<Statement> &statements);
} // namespace alluvium::scene
