#include <alluvium/scene/declared_parameters.h>
#include <alluvium/utilities/nearest_name.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <regex>
#include <sstream>

namespace alluvium::scene
{
  namespace
  {
    ParameterPath parent(const ParameterPath &path)
    {
      return {path.begin(), path.end() - 1};
    }

    void collect(const nlohmann::ordered_json                         &node,
                 ParameterPath                                        &path,
                 std::vector<DeclaredParameter>                       &parameters,
                 std::vector<ParameterPath>                           &sections,
                 std::vector<std::pair<ParameterPath, ParameterPath>> &aliases)
    {
      if (!node.is_object()) // an empty section is written as an empty string
        return;
      for (const auto &[name, entry] : node.items())
        {
          path.push_back(name);
          if (entry.is_object() && entry.contains("value") && entry["value"].is_string())
            parameters.push_back({path,
                                  entry["value"],
                                  entry["default_value"],
                                  entry.value("documentation", std::string()),
                                  entry.value("pattern_description", std::string("[Anything]"))});
          else if (entry.is_object() && entry.contains("alias") && entry["alias"].is_string())
            {
              aliases.emplace_back(path, parent(path)); // both are in one section
              aliases.back().second.push_back(entry["alias"]);
            }
          else
            {
              sections.push_back(path);
              collect(entry, path, parameters, sections, aliases);
            }
          path.pop_back();
        }
    }

    std::string join_selection(const std::string &choices)
    {
      std::string result;
      for (const auto &choice : dealii::Utilities::split_string_list(choices, '|'))
        result += (result.empty() ? "" : ", ") + choice;
      return result;
    }

    std::string range_in_words(const std::string &kind,
                               const std::string &lower,
                               const std::string &upper,
                               const std::string &lowest,
                               const std::string &highest)
    {
      if (lower != lowest && upper != highest)
        return kind + " from " + lower + " to " + upper;
      if (lower != lowest)
        return kind + " >= " + lower;
      if (upper != highest)
        return kind + " <= " + upper;
      return kind;
    }

    /** @p text broken at blanks into lines of at most @p width. */
    std::vector<std::string> wrapped(const std::string &text, const std::size_t width)
    {
      std::vector<std::string> lines;
      std::istringstream       paragraphs(text);
      for (std::string paragraph; std::getline(paragraphs, paragraph);)
        {
          std::istringstream words(paragraph);
          std::string        line;
          for (std::string word; words >> word;)
            if (line.empty())
              line = word;
            else if (line.size() + 1 + word.size() <= width)
              line += " " + word;
            else
              {
                lines.push_back(line);
                line = word;
              }
          if (!line.empty())
            lines.push_back(line);
        }
      return lines;
    }
  } // namespace


  std::string to_string(const ParameterPath &path)
  {
    std::string result;
    for (const auto &name : path)
      result += (result.empty() ? "" : "/") + name;
    return result;
  }


  std::string allowed_in_words(const std::string &pattern)
  {
    // [^] and not . : a selection may hold line breaks.
    static const std::regex integer_range(R"(\[Integer range (-?\d+)\.\.\.(-?\d+) \(inclusive\)\])"),
      double_range(R"(\[Double (\S+?)\.\.\.(\S+) \(inclusive\)\])"), selection(R"(\[Selection ([^]*)\])"),
      multiple_selection(R"(\[MultipleSelection ([^]*)\])"),
      list(R"(\[List of <([^]*)> of length (\d+)\.\.\.(\d+) \(inclusive\)(?: separated by <([^]*)>)?\])"),
      map(R"(\[Map of <([^]*)>:<([^]*)> of length (\d+)\.\.\.(\d+) \(inclusive\)(?: separated by <([^]*)>)?\])");

    std::smatch match;
    if (pattern == "[Bool]")
      return "true or false";
    if (pattern == "[Anything]")
      return "any text";
    if (pattern == "[Integer]")
      return "a whole number";
    if (pattern == "[Double]")
      return "a number";
    if (pattern.compare(0, 9, "[FileName") == 0)
      return "a file name";
    if (pattern.compare(0, 14, "[DirectoryName") == 0)
      return "a folder name";
    if (std::regex_match(pattern, match, integer_range))
      return range_in_words("a whole number", match[1], match[2], "-2147483648", "2147483647");
    if (std::regex_match(pattern, match, double_range))
      return range_in_words("a number", match[1], match[2], "-MAX_DOUBLE", "MAX_DOUBLE");
    if (std::regex_match(pattern, match, selection))
      return "one of: " + join_selection(match[1]);
    if (std::regex_match(pattern, match, multiple_selection))
      return "any of these, separated by commas: " + join_selection(match[1]);
    if (std::regex_match(pattern, match, list))
      {
        const std::string lower = match[2], upper = match[3];
        const std::string separator = match[4].matched && match[4] != "," ? "'" + match[4].str() + "'" : "commas";
        const std::string length    = lower == upper ? lower + " values"
                                      : upper == "4294967295"
                                        ? (lower == "0" ? "any number of values" : "at least " + lower + " values")
                                        : lower + " to " + upper + " values";
        return length + " separated by " + separator + ", each " + allowed_in_words(match[1]);
      }
    if (std::regex_match(pattern, match, map))
      {
        const std::string separator = match[5].matched && match[5] != "," ? "'" + match[5].str() + "'" : "commas";
        return "pairs key:value separated by " + separator + ", each key " + allowed_in_words(match[1]) +
               ", each value " + allowed_in_words(match[2]);
      }
    return pattern;
  }


  DeclaredParameters::DeclaredParameters(const dealii::ParameterHandler &prm)
  {
    std::stringstream stream;
    prm.print_parameters(stream,
                         dealii::ParameterHandler::OutputStyle(dealii::ParameterHandler::JSON |
                                                               dealii::ParameterHandler::KeepDeclarationOrder));
    ParameterPath path;
    collect(nlohmann::ordered_json::parse(stream), path, all_parameters, all_sections, aliases);
  }


  const DeclaredParameter *DeclaredParameters::find(const ParameterPath &path) const
  {
    for (const auto &parameter : all_parameters)
      if (parameter.path == path)
        return &parameter;

    // An old name has no entry of its own: report it as a parameter that takes anything and let deal.II judge.
    static const DeclaredParameter old_name{{}, "", "", "", "[Anything]"};
    return present_name(path) != path ? &old_name : nullptr;
  }


  ParameterPath DeclaredParameters::present_name(const ParameterPath &path) const
  {
    const auto alias =
      std::find_if(aliases.begin(), aliases.end(), [&](const auto &names) { return names.first == path; });
    return alias == aliases.end() ? path : alias->second;
  }


  bool DeclaredParameters::has_section(const ParameterPath &path) const
  {
    return path.empty() || std::find(all_sections.begin(), all_sections.end(), path) != all_sections.end();
  }


  ParameterPath DeclaredParameters::split(const std::string &text) const
  {
    for (const auto &parameter : all_parameters)
      if (to_string(parameter.path) == text)
        return parameter.path;
    for (const auto &[old_name, present] : aliases)
      if (to_string(old_name) == text)
        return old_name;
    ParameterPath path;
    for (const auto &name : dealii::Utilities::split_string_list(text, '/'))
      path.push_back(dealii::Utilities::trim(name));
    return path;
  }


  std::string DeclaredParameters::suggest_parameter(const ParameterPath &path) const
  {
    std::vector<std::string> here, sections_here, elsewhere;
    for (const auto &parameter : all_parameters)
      {
        if (parent(parameter.path) == parent(path))
          here.push_back(parameter.path.back());
        elsewhere.push_back(parameter.path.back());
      }
    for (const auto &section : all_sections)
      if (section == path)
        return "; that is a section: write 'subsection " + path.back() + "'";

    // The right name in the wrong section is a likelier mistake than a misspelling of a neighbour.
    const auto places = [this](const std::string &name) {
      std::vector<std::string> result;
      for (const auto &parameter : all_parameters)
        if (edit_distance(parameter.path.back(), name) == 0)
          result.push_back(parameter.path.size() == 1 ? "outside of all sections"
                                                      : "in section '" + to_string(parent(parameter.path)) + "'");
      std::string text;
      for (std::size_t i = 0; i < std::min<std::size_t>(result.size(), 3); ++i)
        text += (i == 0 ? "" : " and ") + result[i];
      return text + (result.size() > 3 ? " and elsewhere" : "");
    };

    const std::string near_here = nearest_name(path.back(), here);
    if (!near_here.empty() && edit_distance(near_here, path.back()) == 0)
      return "; did you mean '" + near_here + "'?";
    const std::string in_other = places(path.back());
    if (!in_other.empty())
      return "; there is one " + in_other;
    if (!near_here.empty())
      return "; did you mean '" + near_here + "'?";
    const std::string near_elsewhere = nearest_name(path.back(), elsewhere);
    if (!near_elsewhere.empty())
      return "; did you mean '" + near_elsewhere + "' " + places(near_elsewhere) + "?";
    return here.empty() || here.size() > 12 ? "" : "; it has: " + [&] {
      std::string list;
      for (const auto &name : here)
        list += (list.empty() ? "'" : ", '") + name + "'";
      return list;
    }();
  }


  std::string DeclaredParameters::suggest_section(const ParameterPath &path) const
  {
    std::vector<std::string> here, elsewhere;
    for (const auto &section : all_sections)
      {
        if (parent(section) == parent(path))
          here.push_back(section.back());
        else
          elsewhere.push_back(section.back());
      }
    if (find(path) != nullptr)
      return "; that is a parameter: write 'set " + path.back() + " = ...'";

    const std::string near_here      = nearest_name(path.back(), here);
    const std::string near_elsewhere = nearest_name(path.back(), elsewhere);
    if (!near_here.empty() &&
        (near_elsewhere.empty() || edit_distance(near_here, path.back()) <= edit_distance(near_elsewhere, path.back())))
      return "; did you mean '" + near_here + "'?";
    if (!near_elsewhere.empty())
      for (const auto &section : all_sections)
        if (section.back() == near_elsewhere)
          return "; did you mean '" + near_elsewhere + "' " +
                 (section.size() == 1 ? "outside of all sections" : "in section '" + to_string(parent(section)) + "'") +
                 "?";
    if (here.empty())
      return path.size() == 1 ? "" : "; '" + to_string(parent(path)) + "' has no sections inside";
    std::string list;
    for (const auto &name : here)
      list += (list.empty() ? "'" : ", '") + name + "'";
    return "; there are: " + list;
  }


  void DeclaredParameters::print(std::ostream &out) const
  {
    // The parameters of a section that has sections inside may be declared after those: gather each section's own
    // first.
    const auto print_section = [&](const auto &self, const ParameterPath &section) -> void {
      const std::string indent(2 * section.size(), ' ');
      bool              is_first = true;
      const auto        blank    = [&] {
        if (!is_first)
          out << '\n';
        is_first = false;
      };
      for (const auto &parameter : all_parameters)
        if (parent(parameter.path) == section)
          {
            blank();
            for (const auto &line : wrapped(parameter.prose, 110 - indent.size()))
              out << indent << "# " << line << '\n';
            if (parameter.pattern != "[Anything]")
              for (const auto &line : wrapped("Allowed: " + allowed_in_words(parameter.pattern), 110 - indent.size()))
                out << indent << "# " << line << '\n';
            if (parameter.value != parameter.default_value)
              out << indent << "# Default: " << parameter.default_value << '\n';
            out << indent << "set " << parameter.path.back() << " =" << (parameter.value.empty() ? "" : " ")
                << parameter.value << '\n';
          }
      for (const auto &inside : all_sections)
        if (parent(inside) == section)
          {
            blank();
            out << indent << "subsection " << inside.back() << '\n';
            self(self, inside);
            out << indent << "end\n";
          }
    };
    print_section(print_section, {});
  }
} // namespace alluvium::scene
