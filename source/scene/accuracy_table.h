// Written by `contrib/lab choose` from doc/lab/accuracy/results.csv (preliminary): do not edit.
#pragma once

#include <alluvium/scene/accuracy.h>

namespace alluvium::scene
{
  inline const std::vector<AccuracyChoice> &accuracy_table()
  {
    // clang-format off
    static const std::vector<AccuracyChoice> table = {
      {"bed", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "10 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "4"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.2"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "1 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "1 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "1"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "1"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "0.5"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "0.5"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"bed", "0.1 %", "filter", {{"Coupling/Filter radius", "2.5 d"}, {"Coupling/Filter shape", "smooth"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "10 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-2"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "10 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "8"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-4"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"suspension", "0.1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "1"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-2"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "10 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "4"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "1 %", "contacts", {{"Contacts/Residual tolerance", "1e-3"}, {"Contacts/Largest violation", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "1e-3"}, {"Contacts/Largest violation", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"other", "0.1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-1"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "1 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.2"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
      {"dry", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "1e-3"}, {"Contacts/Largest violation", "0.1"}}, "measured with all that is chosen:  off; these are the loosest that were tried"},
    };
    // clang-format on
    return table;
  }
} // namespace alluvium::scene
