#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace alluvium::run
{
  /** A parameter that a restart has another value of than the run that it continues. */
  struct ParameterChange
  {
    std::string name, before, now;
  };

  /**
   * Where @p now, (name, value), differs from @p before; numbers are compared as such. How a run is started, ended and
   * shown, and where it writes, does not count.
   */
  std::vector<ParameterChange> changed_parameters(const std::map<std::string, std::string>               &before,
                                                  const std::vector<std::pair<std::string, std::string>> &now);

  /** Whether the walls of @p changes may be others, or move otherwise. */
  bool change_walls(const std::vector<ParameterChange> &changes);

  /**
   * Whether @p changes change what holds between grains and walls. What was known to rest may rest no more then, with
   * the same loads. (Loads are compared in any case: fluid and boundary conditions may be others.)
   */
  bool change_contacts(const std::vector<ParameterChange> &changes);

  /**
   * Describe @p changes, a line for each. Throws UserError with all those that would be ignored, since a checkpoint
   * holds what had been made of them: grains, unrefined mesh, columns of statistics.csv. @p never_refines: the mesh was
   * made so that it cannot be adapted; @p adapts: the parameters want that.
   */
  std::vector<std::string> accept_changes(const std::vector<ParameterChange> &changes, bool never_refines, bool adapts);
} // namespace alluvium::run
