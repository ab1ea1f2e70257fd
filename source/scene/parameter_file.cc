#include <alluvium/scene/accuracy.h>
#include <alluvium/scene/parameter_file.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/magnitudes.h>
#include <alluvium/utilities/nearest_name.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace alluvium::scene
{
  namespace
  {
    std::string trim(const std::string &text)
    {
      const auto first = text.find_first_not_of(" \t\r\n");
      return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
    }

    /** The scanner of one file; include makes another one that goes on with the same sections. */
    class Scanner
    {
    public:
      std::vector<Statement> statements;

      void scan(const std::string &file_name)
      {
        const std::string quoted = "parameter file '" + file_name + "'";
        std::error_code   error;
        const auto        canonical = std::filesystem::weakly_canonical(file_name, error);
        check_user(std::find(open_files.begin(), open_files.end(), canonical) == open_files.end(),
                   where + "'" + file_name + "' includes itself.");
        check_user(std::filesystem::exists(file_name, error), where + "There is no " + quoted + ".");
        check_user(!std::filesystem::is_directory(file_name, error), where + "The " + quoted + " is a folder.");
        errno = 0;
        std::ifstream stream(file_name);
        check_user(stream.good(), where + "The " + quoted + " cannot be read: " + std::strerror(errno) + ".");

        note_input(file_name);
        open_files.push_back(canonical);
        const std::size_t depth = sections.size();
        std::string       line, text;
        unsigned int      number = 0, first_number = 0;
        bool              continues = false;
        while (std::getline(stream, line))
          {
            if (++number == 1)
              strip_byte_order_mark(line, where + "The " + quoted);
            check_user(line.find('\0') == std::string::npos, where + "The " + quoted + " is no text.");
            if (!continues)
              {
                text.clear();
                first_number = number;
              }
            line      = trim(line);
            continues = !line.empty() && line.back() == '\\';
            if (continues)
              line.pop_back();
            text += line;
            if (!continues)
              scan_line(text, file_name, first_number, depth);
          }
        check_user(!stream.bad(), where + "The " + quoted + " cannot be read.");
        check_user(!continues,
                   file_name + ":" + std::to_string(number) + ": the last line ends with a '\\' that nothing follows.");
        if (sections.size() > depth)
          throw UserError(opened_at[depth] + ": subsection '" + sections[depth] + "' is never closed by an 'end'.");
        open_files.pop_back();
      }

    private:
      void scan_line(std::string text, const std::string &file_name, const unsigned int number, const std::size_t depth)
      {
        const std::string origin = file_name + ":" + std::to_string(number);
        text                     = trim(with_plain_blanks(text.substr(0, text.find('#'))));
        if (text.empty())
          return;

        const auto        blank = text.find_first_of(" \t");
        const std::string word  = text.substr(0, blank),
                          rest  = blank == std::string::npos ? "" : trim(text.substr(blank));
        const auto is           = [&](const char *keyword) {
          std::string upper(keyword);
          std::transform(upper.begin(), upper.end(), upper.begin(), ::toupper);
          return word == keyword || word == upper;
        };

        if (is("subsection"))
          {
            check_user(!rest.empty(), origin + ": 'subsection' needs a name.");
            sections.push_back(rest);
            opened_at.push_back(origin);
            statements.push_back({sections, "", origin, true, open_files.back().string(), number});
          }
        else if (is("end"))
          {
            check_user(rest.empty(), origin + ": nothing may follow 'end', but '" + rest + "' does.");
            check_user(sections.size() > depth, origin + ": there is no open subsection for this 'end' to close.");
            sections.pop_back();
            opened_at.pop_back();
          }
        else if (is("set"))
          {
            const auto equals = rest.find('=');
            check_user(equals != std::string::npos && !trim(rest.substr(0, equals)).empty(),
                       origin + ": expected 'set NAME = VALUE', found '" + text + "'.");
            ParameterPath path = sections;
            path.push_back(trim(rest.substr(0, equals)));
            statements.push_back(
              {path, trim(rest.substr(equals + 1)), origin, false, open_files.back().string(), number});
          }
        else if (is("include"))
          {
            check_user(!rest.empty(), origin + ": 'include' needs a file name.");
            const std::string where_before = where;
            where                          = origin + ": ";
            scan((std::filesystem::path(file_name).parent_path() / rest).string());
            where = where_before;
          }
        else
          {
            const std::string nearest = nearest_name(word, {"subsection", "set", "end", "include"});
            throw UserError(origin + ": cannot understand '" + text + "'; " +
                            (nearest.empty() ? "a line starts with 'subsection', 'set', 'end', 'include' or '#'."
                                             : "did you mean '" + nearest + "'?"));
          }
      }

      ParameterPath                      sections;
      std::vector<std::string>           opened_at;
      std::vector<std::filesystem::path> open_files;
      std::string                        where; // of the include that opened the present file
    };

    bool matches(const std::string &pattern, const std::string &value)
    {
      return dealii::Patterns::pattern_factory(pattern)->match(value);
    }

    /** Set without checks, in whatever section @p prm is not. */
    void set(dealii::ParameterHandler &prm, const ParameterPath &path, const std::string &value)
    {
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        prm.enter_subsection(path[i]);
      const auto leave = [&] {
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
          prm.leave_subsection();
      };
      try
        {
          prm.set(path.back(), value);
        }
      catch (...)
        {
          leave();
          throw;
        }
      leave();
    }

    std::string in_section(const ParameterPath &path)
    {
      const ParameterPath sections(path.begin(), path.end() - 1);
      return sections.empty() ? "outside of all sections" : "in section '" + to_string(sections) + "'";
    }

    /** The name that stands twice in @p value, a list of names or of `name: value`, or empty. */
    std::string name_twice(const std::string &pattern, const std::string &value)
    {
      const auto is = [&](const std::string &kind) { return pattern.compare(0, kind.size(), kind) == 0; };
      if (!is("[Map of ") && !is("[MultipleSelection "))
        return "";
      std::vector<std::string> names;
      for (const std::string &item : dealii::Utilities::split_string_list(value))
        {
          const std::string name = trim(item.substr(0, item.find(':')));
          if (std::find(names.begin(), names.end(), name) != names.end())
            return name;
          names.push_back(name);
        }
      return "";
    }

    /** Is one of the numbers that @p value is by its @p pattern larger or smaller than can be computed with? */
    bool is_beyond_size(const std::string &pattern, const std::string &value)
    {
      const auto is = [&](const std::string &kind) { return pattern.compare(0, kind.size(), kind) == 0; };
      if (!is("[Double") && !is("[List of <[Double"))
        return false;
      for (const std::string &item : dealii::Utilities::split_string_list(value))
        if (const double size = std::abs(std::strtod(item.c_str(), nullptr));
            size > magnitudes::largest || (size > 0. && size < magnitudes::smallest))
          return true;
      return false;
    }

    std::string bad_value(const Statement &statement, const std::string &pattern)
    {
      std::string text = statement.origin + ": parameter '" + to_string(statement.path) + "' ";
      text += statement.value.empty() ? "has no value" : "cannot be '" + statement.value + "'";
      text += ": expected " + allowed_in_words(pattern) + ".";

      const std::string selection = "[Selection ";
      if (pattern.compare(0, selection.size(), selection) == 0)
        {
          auto choices = dealii::Utilities::split_string_list(
            pattern.substr(selection.size(), pattern.size() - selection.size() - 1), '|');
          const std::string nearest = nearest_name(statement.value, choices);
          if (!nearest.empty())
            text += " Did you mean '" + nearest + "'?";
        }
      return text + look_alikes_in(statement.value);
    }
  } // namespace


  std::vector<Statement> read_statements(const std::string &file_name)
  {
    Scanner scanner;
    scanner.scan(file_name);
    return std::move(scanner.statements);
  }


  Statement read_assignment(const std::string &text, const DeclaredParameters &declared)
  {
    const std::string origin = "--set '" + text + "'";
    const auto        equals = text.find('=');
    check_user(equals != std::string::npos && !trim(text.substr(0, equals)).empty(),
               origin + ": expected --set 'Section/Name=value'.");
    return {declared.split(trim(text.substr(0, equals))), trim(text.substr(equals + 1)), origin, false, "", 0};
  }


  void apply_statements(dealii::ParameterHandler &prm, const std::vector<Statement> &statements)
  {
    const DeclaredParameters declared(prm);

    std::vector<std::string>   problems;
    std::vector<ParameterPath> unknown_sections;
    for (const auto &statement : statements)
      {
        // One message for an unknown section, not another one for everything in it.
        const auto is_inside = [&](const ParameterPath &section) {
          return section.size() <= statement.path.size() &&
                 std::equal(section.begin(), section.end(), statement.path.begin());
        };
        if (std::any_of(unknown_sections.begin(), unknown_sections.end(), is_inside))
          continue;

        const std::size_t n_sections = statement.path.size() - (statement.opens_section ? 0 : 1);
        bool              is_known   = true;
        for (std::size_t n = 1; n <= n_sections && is_known; ++n)
          {
            const ParameterPath section(statement.path.begin(), statement.path.begin() + n);
            if (!declared.has_section(section))
              {
                is_known = false;
                unknown_sections.push_back(section);
                problems.push_back(statement.origin + ": there is no section '" + section.back() + "' " +
                                   in_section(section) + declared.suggest_section(section));
              }
          }
        if (!is_known || statement.opens_section)
          continue;

        const DeclaredParameter *parameter = declared.find(statement.path);
        if (!is_utf8(statement.value))
          problems.push_back(statement.origin + ": the value of '" + to_string(statement.path) +
                             "' has characters that are not UTF-8; save the file as UTF-8.");
        else if (parameter == nullptr)
          problems.push_back(statement.origin + ": there is no parameter '" + statement.path.back() + "' " +
                             in_section(statement.path) + declared.suggest_parameter(statement.path));
        else if (!matches(parameter->pattern, statement.value))
          problems.push_back(bad_value(statement, parameter->pattern));
        else if (is_beyond_size(parameter->pattern, statement.value))
          problems.push_back(statement.origin + ": parameter '" + to_string(statement.path) + "' cannot be '" +
                             statement.value + "': expected " + allowed_in_words(parameter->pattern) +
                             ", of a size from 1e-30 to 1e30 if it is not 0.");
        else if (const std::string twice = name_twice(parameter->pattern, statement.value); !twice.empty())
          problems.push_back(statement.origin + ": parameter '" + to_string(statement.path) + "' has '" + twice +
                             "' twice; it can be there once.");
      }

    if (!problems.empty())
      {
        const std::size_t shown = std::min<std::size_t>(problems.size(), 10);
        std::string       text;
        for (std::size_t i = 0; i < shown; ++i)
          text += (i == 0 ? "" : "\n") + problems[i];
        if (problems.size() > shown)
          text += "\n... and " + std::to_string(problems.size() - shown) + " more.";
        throw UserError(text);
      }

    for (const auto &statement : statements)
      if (!statement.opens_section)
        try
          {
            set(prm, statement.path, statement.value);
          }
        // A value can fit the pattern and still not convert: an integer too large, an alias with a pattern of its own.
        catch (const dealii::ExceptionBase &exception)
          {
            std::ostringstream info;
            exception.print_info(info);
            throw UserError(statement.origin + ": parameter '" + to_string(statement.path) + "' cannot be '" +
                            statement.value + "': " + trim(info.str()));
          }
        catch (const UserError &error)
          {
            throw UserError(statement.origin + ": " + error.what());
          }
        catch (const std::exception &exception)
          {
            throw UserError(statement.origin + ": parameter '" + to_string(statement.path) + "' cannot be '" +
                            statement.value + "': " + exception.what());
          }
  }


  std::vector<std::string> find_repetitions(const std::vector<Statement> &statements,
                                            const DeclaredParameters     &declared)
  {
    std::map<std::pair<std::string, ParameterPath>, const Statement *> earlier; // by file and present name
    std::vector<std::string>                                           found;
    for (const Statement &now : statements)
      {
        if (now.opens_section || now.file.empty())
          continue;
        const Statement *&before = earlier[{now.file, declared.present_name(now.path)}];
        if (before != nullptr && before->line != now.line) // else the file is included twice
          found.push_back(now.origin + ": parameter '" + to_string(now.path) + "' is set twice in this file: '" +
                          now.value + "' overrides the '" + before->value + "' of line " +
                          std::to_string(before->line) +
                          (before->path == now.path ? "" : ", where it is called '" + before->path.back() + "'") +
                          ". Delete one of the lines.");
        before = &now;
      }
    return found;
  }


  void declare_method(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Method",
                      "default",
                      dealii::Patterns::Selection("default|paper"),
                      "Which defaults the other parameters have: 'default' the ones recommended here, 'paper' those of "
                      "the published method. Whatever else this file sets overrides them.");
  }


  std::vector<Statement> method_statements(const dealii::ParameterHandler &prm,
                                           const std::vector<Statement>   &statements,
                                           const ParameterOverrides       &paper_method)
  {
    std::string method = prm.get("Method");
    for (const auto &statement : statements)
      if (statement.path == ParameterPath{"Method"} && !statement.opens_section)
        method = statement.value;
    std::vector<Statement> overrides;
    if (method == "paper")
      {
        const DeclaredParameters declared(prm);
        for (const auto &[name, value] : paper_method)
          overrides.push_back({declared.split(name), value, "Method = paper", false, "", 0});
      }
    return overrides;
  }


  Remarks read_parameters(dealii::ParameterHandler       &prm,
                          const std::string              &file_name,
                          const std::vector<std::string> &assignments,
                          const ParameterOverrides       &paper_method)
  {
    std::vector<Statement> statements;
    if (!file_name.empty())
      statements = read_statements(file_name);

    const DeclaredParameters declared(prm);
    for (const auto &assignment : assignments)
      statements.push_back(read_assignment(assignment, declared));

    Remarks remarks;
    remarks.warnings = find_repetitions(statements, declared);
    // what the scene says comes after what Method says, and that after what Accuracy says
    const auto method = method_statements(prm, statements, paper_method);
    statements.insert(statements.begin(), method.begin(), method.end());
    remarks.choices = apply_accuracy(prm, statements);
    apply_statements(prm, statements);
    return remarks;
  }
} // namespace alluvium::scene
