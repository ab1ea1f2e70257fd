#pragma once

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::scene
{
  /**
   * Load the shared libraries that the parameter file @p file_name (none if empty) and the @p assignments of the
   * command line ask for: their plug-ins register themselves, so this comes before parameters are declared. File names
   * are relative to the parameter file's folder. Returns the value of `Additional shared libraries` with whole paths,
   * empty if there is none. Throws UserError with the file's name for one that is not there, cannot be loaded, or has
   * no plug-in; loaded ones stay until the program ends.
   */
  std::string load_shared_libraries(const std::string &file_name, const std::vector<std::string> &assignments);

  /** Declare the parameter `Additional shared libraries`, at the top level. */
  void declare_shared_libraries(dealii::ParameterHandler &prm);

  /** Let @p prm have the whole paths of what was loaded: it may be written elsewhere, and read again there. */
  void set_shared_libraries(dealii::ParameterHandler &prm, const std::string &loaded);
} // namespace alluvium::scene
