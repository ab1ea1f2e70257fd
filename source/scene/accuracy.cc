#include <alluvium/scene/accuracy.h>

#include "accuracy_table.h"

#include <alluvium/utilities/digits.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace alluvium::scene
{
  namespace
  {
    /** The names in `name: value; name: value`, each with its value. */
    ParameterOverrides named_values(const std::string &text)
    {
      ParameterOverrides found;
      for (const std::string &item : dealii::Utilities::split_string_list(text, ';'))
        {
          const auto colon = item.find(':');
          if (colon != std::string::npos)
            found.emplace_back(dealii::Utilities::trim(item.substr(0, colon)),
                               dealii::Utilities::trim(item.substr(colon + 1)));
        }
      return found;
    }

    /** Whether gravity, `g_x, g_y`, is along x rather than y, so that a bed's faces are left and right of it. */
    bool is_along_x(const std::string &gravity)
    {
      const auto parts = dealii::Utilities::split_string_list(gravity, ',');
      try
        {
          return parts.size() == 2 && std::abs(std::stod(parts[0])) > std::abs(std::stod(parts[1]));
        }
      catch (const std::exception &) // what it should have been is said where it is parsed
        {
          return false;
        }
    }

    std::string in_words(const Statement &own)
    {
      return to_string(own.path) + " = " + own.value + " (" + own.origin + ")";
    }

    /** What else the fluid does than to come and go through the sides below and above a bed, or nothing. */
    std::string other_flow(const std::function<std::string(const std::string &)> &value_of)
    {
      const bool                     along_x = is_along_x(value_of("Gravity"));
      const std::vector<std::string> faces =
        along_x ? std::vector<std::string>{"left", "right"} : std::vector<std::string>{"bottom", "top"};
      std::set<std::string> open;
      for (const std::string section : {"Pressure", "Velocity", "Plug-ins"})
        for (const auto &[name, value] : named_values(value_of("Boundary conditions/" + section)))
          {
            if (std::find(faces.begin(), faces.end(), name) == faces.end())
              return "fluid enters or leaves by '" + name + "'";
            const auto components = dealii::Utilities::split_string_list(value, '|');
            if (section == "Velocity" && components.size() == 2 && components[along_x ? 0 : 1] == "0")
              return "'" + name + "' moves along the bed";
            open.insert(name);
          }
      for (const std::string name : {"Body force", "Mean pressure gradient"})
        if (value_of("Fluid/" + name).find_first_not_of("0. |") != std::string::npos)
          return "Fluid/" + name + " drives the fluid";
      return open.size() == faces.size() ? "" : "no fluid goes through '" + faces[0] + "' and '" + faces[1] + "'";
    }
  } // namespace


  const std::vector<AccuracyChoice> &accuracy_choices()
  {
    return accuracy_table();
  }


  AccuracyKind find_accuracy_kind(const std::function<std::string(const std::string &)> &value_of)
  {
    if (value_of("Fluid/Model") == "none")
      return {"dry", "dry grains"};
    const std::string deposit = value_of("Grains/Deposit");
    if (deposit == "random suspension")
      return {"suspension", "a suspension: cells are even"};
    if (deposit != "settled bed")
      return {"other",
              "grains of which it is not known before they are there whether they are a bed (Deposit = " + deposit +
                "): cells are even"};
    if (!value_of("Grains/Deposit: settled bed/Box").empty())
      return {"other", "a bed in a box, not all over the floor: cells are even"};
    const std::string flow = other_flow(value_of);
    if (!flow.empty())
      return {"other", flow + ": cells are even"};
    return {"bed", "a bed whose fluid comes and goes through its two faces: cells are fine along these"};
  }


  void declare_accuracy(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Accuracy",
      "off",
      dealii::Patterns::Selection("off|10 %|1 %|0.1 %"),
      "How large the error of what a run is made for (a flux, the head of an onset, how fast or how far grains move) "
      "may be. It chooses defaults for the time step, the tolerances of contacts, coupling and linear solver, cells and "
      "filter, from errors and costs that were measured on scenes of the same kind; `--check` says each with its "
      "reason. Whatever else this file sets overrides them. `off`: the defaults are those that each parameter has.");
  }


  std::vector<std::string> apply_accuracy(dealii::ParameterHandler     &prm,
                                          const std::vector<Statement> &statements)
  {
    const DeclaredParameters declared(prm);
    const auto               statement_of = [&](const std::string &name) -> const Statement * {
      const ParameterPath path = declared.split(name);
      for (auto s = statements.rbegin(); s != statements.rend(); ++s)
        if (!s->opens_section && s->path == path)
          return &*s;
      return nullptr;
    };
    const auto value_of = [&](const std::string &name) -> std::string {
      const Statement         *own       = statement_of(name);
      const DeclaredParameter *parameter = declared.find(declared.split(name));
      return own ? own->value : parameter ? parameter->value : "";
    };

    const std::string accuracy = value_of("Accuracy");
    if (accuracy == "off" || accuracy.empty())
      return {};

    const AccuracyKind       kind = find_accuracy_kind(value_of);
    std::vector<std::string> lines{accuracy + ", as measured for: " + kind.reason};
    std::vector<Statement>   overrides;
    for (const auto &choice : accuracy_choices())
      {
        if (choice.kind != kind.name || choice.accuracy != accuracy)
          continue;
        // of no use there
        if ((choice.group == "contacts" || choice.group == "coupling") && value_of("Grains/Fixed") == "true")
          continue;
        if (choice.group == "coupling" && value_of("Coupling/Time scheme") != "iterated")
          continue;
        if (std::find(lines.begin(), lines.end(), choice.reason) == lines.end()) // the same for what was measured together
          lines.push_back(choice.reason);
        std::string left_alone;
        if (choice.group == "cells" && !value_of("Domain/Mesh file").empty())
          left_alone = "those of Domain/Mesh file, " + value_of("Domain/Mesh file");
        else if (choice.group == "cells" && value_of("Grains/Deposit") == "none")
          left_alone = "as the scene has them: there is no grain to measure them in";
        else if (const Statement *own = statement_of(choice.values.front().first);
                 own && own->value != choice.values.front().second)
          left_alone = "as the scene has them: " + in_words(*own);
        std::string text;
        if (left_alone.empty())
          for (const auto &[name, value] : choice.values)
            {
              const Statement *own = statement_of(name);
              if (!own)
                overrides.push_back({declared.split(name), value, "Accuracy = " + accuracy, false, "", 0});
              text += (text.empty() ? "" : ", ") + (own ? in_words(*own) : name + " = " + value);
            }
        lines.push_back(choice.group + ": " + (left_alone.empty() ? text : left_alone));
      }
    // what terms of the model may take, if they may be left out
    const std::string of_model = "Automatic model/Accuracy";
    if (value_of("Model") == "auto" && !statement_of(of_model))
      {
        const double percent = std::stod(accuracy);
        overrides.push_back(
          {declared.split(of_model), in_digits(percent / 100.), "Accuracy = " + accuracy, false, "", 0});
        lines.push_back("model: " + of_model + " = " + overrides.back().value);
      }
    apply_statements(prm, overrides);
    return lines;
  }
} // namespace alluvium::scene
