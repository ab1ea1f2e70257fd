#include <alluvium/run/restart_parameters.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace alluvium::run
{
  namespace
  {
    bool begins_with(const std::string &text, const std::string &beginning)
    {
      return text.compare(0, beginning.size(), beginning) == 0;
    }

    bool same(const std::string &a, const std::string &b)
    {
      if (a == b)
        return true;
      char        *end_a = nullptr, *end_b = nullptr;
      const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
      return !a.empty() && !b.empty() && *end_a == '\0' && *end_b == '\0' && x == y;
    }

    /** Of the run as a process, not of what it computes. */
    bool is_of_the_process(const std::string &name)
    {
      const std::array<std::string, 4> names = {
        {"Output/Output folder", "Output/Overwrite output folder", "Output/Restart", "Output/Progress"}};
      return std::find(names.begin(), names.end(), name) != names.end();
    }

    bool is_ignored(const std::string &name, const bool never_refines, const bool adapts)
    {
      if (begins_with(name, "Grains/"))
        return name != "Grains/Fixed" && name != "Grains/Extra walls" && name != "Grains/Motion of walls" &&
               name != "Grains/Presence of walls";
      if (begins_with(name, "Mesh refinement/"))
        return never_refines || name == "Mesh refinement/Coarsest cell size" ||
               (!adapts && name != "Mesh refinement/Interval");
      return begins_with(name, "Domain/") || name == "Fluid/Model" || name == "Contacts/Contact model" ||
             name == "Output/Observers" || name == "Output/Format";
    }
  } // namespace


  std::vector<ParameterChange> changed_parameters(const std::map<std::string, std::string>               &before,
                                                  const std::vector<std::pair<std::string, std::string>> &now)
  {
    std::vector<ParameterChange> changes;
    for (const auto &[name, value] : now)
      if (const auto old = before.find(name);
          old != before.end() && !same(old->second, value) && !is_of_the_process(name))
        changes.push_back({name, old->second, value});
    return changes;
  }


  bool change_walls(const std::vector<ParameterChange> &changes)
  {
    return std::any_of(changes.begin(), changes.end(), [](const ParameterChange &change) {
      return change.name == "Grains/Extra walls" || change.name == "Grains/Motion of walls" ||
             change.name == "Grains/Presence of walls";
    });
  }


  bool change_contacts(const std::vector<ParameterChange> &changes)
  {
    return std::any_of(changes.begin(), changes.end(), [](const ParameterChange &change) {
      return begins_with(change.name, "Grains/") || begins_with(change.name, "Contacts/") ||
             begins_with(change.name, "Domain/") || change.name == "Gravity" || change.name == "Time/Time step";
    });
  }


  std::vector<std::string>
  accept_changes(const std::vector<ParameterChange> &changes, const bool never_refines, const bool adapts)
  {
    std::vector<std::string> taken;
    std::string              ignored;
    for (const auto &change : changes)
      {
        const std::string line = change.name + ": " + change.before + " -> " + change.now;
        if (is_ignored(change.name, never_refines, adapts))
          ignored += "\n  " + line;
        else
          taken.push_back(line);
      }
    check_user(ignored.empty(),
               "Output/Restart: these have changed since the checkpoint was written and would be ignored, as it holds "
               "what was made of them. Set them back, or start anew:" +
                 ignored);
    return taken;
  }
} // namespace alluvium::run
