#pragma once

#include <alluvium/scene/declared_parameters.h>

#include <string>
#include <utility>
#include <vector>

namespace alluvium::scene
{
  /** One line of a parameter file or of the command line: a value for a parameter, or the opening of a section. */
  struct Statement
  {
    ParameterPath path;
    std::string   value;
    std::string   origin; // 'file.prm:12' or the command line option: for messages
    bool          opens_section = false;
    std::string   file; // that the line is in; empty for the command line
    unsigned int  line = 0;
  };

  /** (path 'Section/Name', value) */
  using ParameterOverrides = std::vector<std::pair<std::string, std::string>>;

  /**
   * Read the lines of a parameter file (deal.II's language: subsection, set, end, include, '#' comments, '\' at the end
   * continues a line) without knowing what is declared. Included files are looked for beside the including one.
   * Throws a UserError with file and line for whatever is not of this language.
   */
  std::vector<Statement> read_statements(const std::string &file_name);

  /** Read 'Section/Name=value'. */
  Statement read_assignment(const std::string &text, const DeclaredParameters &declared);

  /**
   * Give the statements' values to @p prm. Nothing is set before all names and values have been found good; the
   * UserError lists everything that is wrong, each with its origin, and the nearest declared name or what would have
   * been allowed.
   */
  void apply_statements(dealii::ParameterHandler &prm, const std::vector<Statement> &statements);

  /**
   * One sentence for each line that sets what an earlier line of the same file has set already, maybe under an old
   * name. To override what an included file or the command line says is no mistake.
   */
  std::vector<std::string> find_repetitions(const std::vector<Statement> &statements,
                                             const DeclaredParameters     &declared);

  /** Declare the top-level parameter Method, a choice that changes the defaults of others, as Accuracy does. */
  void declare_method(dealii::ParameterHandler &prm);

  /** What `Method` sets, if @p statements choose the method of the paper: what @p paper_method says; it comes before
   * them. */
  std::vector<Statement> method_statements(const dealii::ParameterHandler &prm,
                                           const std::vector<Statement>   &statements,
                                           const ParameterOverrides       &paper_method);

  /** What reading the parameters has to say. */
  struct Remarks
  {
    std::vector<std::string> choices;  // what Accuracy has chosen, in lines for the scene's report
    std::vector<std::string> warnings; // of find_repetitions()
  };

  /**
   * All of the above in order: the file (if the name is not empty), then the @p assignments of the command line.
   */
  Remarks read_parameters(dealii::ParameterHandler       &prm,
                          const std::string              &file_name,
                          const std::vector<std::string> &assignments,
                          const ParameterOverrides       &paper_method);
} // namespace alluvium::scene
