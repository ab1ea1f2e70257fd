#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::scene
{
  /** Where a parameter or section is: the names of the sections around it, then its own. */
  using ParameterPath = std::vector<std::string>;

  /** 'Section/Subsection/Name' */
  std::string to_string(const ParameterPath &path);

  /** One parameter as declared. */
  struct DeclaredParameter
  {
    ParameterPath path;
    std::string   value, default_value, prose;
    std::string   pattern; // deal.II's description of what values are allowed
  };

  /** Everything that a ParameterHandler has had declared, in that order: ParameterHandler itself cannot be asked. */
  class DeclaredParameters
  {
  public:
    explicit DeclaredParameters(const dealii::ParameterHandler &prm);

    const std::vector<DeclaredParameter> &parameters() const { return all_parameters; }

    /** The parameter at @p path, or nullptr. */
    const DeclaredParameter *find(const ParameterPath &path) const;

    /** The present path of a parameter that @p path names, maybe by an old name; otherwise @p path itself. */
    ParameterPath present_name(const ParameterPath &path) const;

    bool has_section(const ParameterPath &path) const;

    /** Cut 'Section/Name' into a path. A name may have a slash in it, so whatever is declared decides. */
    ParameterPath split(const std::string &text) const;

    /** What to do about the unknown parameter @p path: '; did you mean ...?' or empty. */
    std::string suggest_parameter(const ParameterPath &path) const;

    /** What to do about the unknown section @p path: '; did you mean ...?' or empty. */
    std::string suggest_section(const ParameterPath &path) const;

    /** Write all parameters as a parameter file with prose, allowed values and defaults as comments. */
    void print(std::ostream &out) const;

  private:
    std::vector<DeclaredParameter> all_parameters;
    std::vector<ParameterPath>     all_sections;

    std::vector<std::pair<ParameterPath, ParameterPath>> aliases; // old names, read but not shown, and the present ones
  };

  /** What a deal.II pattern allows, for a human: '[Double 0...MAX_DOUBLE (inclusive)]' is 'a number >= 0'. */
  std::string allowed_in_words(const std::string &pattern);
} // namespace alluvium::scene
