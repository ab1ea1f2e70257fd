#pragma once

#include <string>

namespace alluvium::observers
{
  /** What decided the length of a step that the program chose. */
  struct TimeStepChoice
  {
    std::string  limit;             // what kept it from being longer
    double       margin       = 0.; // the time scheme's stability limit over it; 0: there is none
    unsigned int n_taken_back = 0;  // steps so far
  };
} // namespace alluvium::observers
