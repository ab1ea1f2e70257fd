#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/function_parser.h>

#include <cctype>
#include <iostream>

namespace alluvium
{
  using namespace dealii;

  namespace
  {
    bool is_of_a_name(const char c)
    {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    }

    /** Is there a comma that does not stand between the arguments of a function? */
    bool has_several_values(const std::string &expression)
    {
      std::vector<bool> in_function;
      char              last = ' ';
      for (const char c : expression)
        {
          if (c == '(')
            in_function.push_back(is_of_a_name(last));
          else if (c == ')' && !in_function.empty())
            in_function.pop_back();
          else if (c == ',' && (in_function.empty() || !in_function.back()))
            return true;
          if (c != ' ')
            last = c;
        }
      return false;
    }

    /** Does it look as if somebody wrote decimals with a comma? */
    bool has_decimal_comma(const std::string &expression)
    {
      const auto digit = [&](const std::size_t i) { return std::isdigit(static_cast<unsigned char>(expression[i])); };
      for (std::size_t i = 1; i + 1 < expression.size(); ++i)
        if (expression[i] == ',' && digit(i - 1) && digit(i + 1))
          return true;
      return false;
    }
    /** Is there a `=` of its own? muParser gives the variable before it another value, for all that comes after. */
    bool has_assignment(const std::string &expression)
    {
      const std::string comparing = "<>=!";
      for (std::size_t i = 0; i < expression.size(); ++i)
        if (expression[i] == '=' && (i == 0 || comparing.find(expression[i - 1]) == std::string::npos) &&
            (i + 1 == expression.size() || expression[i + 1] != '='))
          return true;
      return false;
    }

    /** deal.II prints what muParser has to say of a mistake, beside throwing it. Nothing is printed while this lives.
     */
    class Silence
    {
    public:
      Silence()
        : screen(std::cerr.rdbuf(nullptr))
      {}

      ~Silence() { std::cerr.rdbuf(screen); }

      Silence(const Silence &)            = delete;
      Silence &operator=(const Silence &) = delete;

    private:
      std::streambuf *const screen;
    };
  } // namespace


  std::shared_ptr<Function<2>> parse_expressions(const std::string                   &where,
                                                 const std::vector<std::string>      &components,
                                                 const std::map<std::string, double> &constants)
  {
    std::string text;
    for (const auto &component : components)
      {
        text += (text.empty() ? "" : " | ") + component;
        check_user(!has_several_values(component),
                   where + ": '" + component +
                     "' are several values, separated by a comma, where one is expected; decimals are written with a "
                     "point.");
        check_user(!has_assignment(component),
                   where + ": '" + component + "' has a single '='; to compare, write '=='.");
      }
    auto result = std::make_shared<FunctionParser<2>>(components.size());
    try
      {
        const Silence silence;
        result->initialize(FunctionParser<2>::default_variable_names() + ",t", components, constants, true);
        result->value(Point<2>());
      }
    catch (const std::exception &)
      {
        std::string names;
        for (const auto &[name, value] : constants)
          names += ", " + name;
        throw UserError(where + ": cannot understand '" + text + "'; it may use x, y, t" + names + "." +
                        (has_decimal_comma(text) ? " Decimals are written with a point, not a comma." : "") +
                        look_alikes_in(text));
      }
    return result;
  }


  bool mentions(const std::string &expression, const std::string &name)
  {
    for (std::size_t at = expression.find(name); at != std::string::npos; at = expression.find(name, at + 1))
      {
        const std::size_t end = at + name.size();
        if ((at == 0 || !is_of_a_name(expression[at - 1])) &&
            (end == expression.size() || !is_of_a_name(expression[end])))
          return true;
      }
    return false;
  }
} // namespace alluvium
