#pragma once

#include <deal.II/base/function.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alluvium
{
  /**
   * Parse formulas in x, y, t and @p constants, one for each component. Throws a UserError that starts with @p where,
   * for what cannot be understood and for several values in one formula: muParser takes `0,5` for two, and goes on with
   * the last.
   */
  std::shared_ptr<dealii::Function<2>> parse_expressions(const std::string                   &where,
                                                         const std::vector<std::string>      &components,
                                                         const std::map<std::string, double> &constants);

  /** Does @p expression use the variable @p name? */
  bool mentions(const std::string &expression, const std::string &name);
} // namespace alluvium
