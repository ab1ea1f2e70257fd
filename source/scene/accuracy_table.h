// Written by `contrib/lab choose` from doc/lab/accuracy/results.csv (alluvium 0.1.0 (1bccac9d01)): do not edit.
#pragma once

#include <alluvium/scene/accuracy.h>

namespace alluvium::scene
{
  inline const std::vector<AccuracyChoice> &accuracy_table()
  {
    // clang-format off
    static const std::vector<AccuracyChoice> table = {
      {"bed", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: flux 3.6 %, onset 0.14 %, heave 0.58 % off; these are the loosest that were tried"},
      {"bed", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen: flux 3.6 %, onset 0.14 %, heave 0.58 % off; these are the loosest that were tried"},
      {"bed", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen: flux 3.6 %, onset 0.14 %, heave 0.58 % off; these are the loosest that were tried"},
      {"bed", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen: flux 3.6 %, onset 0.14 %, heave 0.58 % off; these are the loosest that were tried"},
      {"bed", "10 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "4"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen: flux 3.6 %, onset 0.14 %, heave 0.58 % off; these are the loosest that were tried"},
      {"bed", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: flux 0.99 %, onset 0.015 %, heave 0.15 % off; the next looser settings: flux 3.6 %, onset 0.14 %, heave 0.58 %"},
      {"bed", "1 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen: flux 0.99 %, onset 0.015 %, heave 0.15 % off; the next looser settings: flux 3.6 %, onset 0.14 %, heave 0.58 %"},
      {"bed", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen: flux 0.99 %, onset 0.015 %, heave 0.15 % off; the next looser settings: flux 3.6 %, onset 0.14 %, heave 0.58 %"},
      {"bed", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen: flux 0.99 %, onset 0.015 %, heave 0.15 % off; the next looser settings: flux 3.6 %, onset 0.14 %, heave 0.58 %"},
      {"bed", "1 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "2"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "2"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen: flux 0.99 %, onset 0.015 %, heave 0.15 % off; the next looser settings: flux 3.6 %, onset 0.14 %, heave 0.58 %"},
      {"bed", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"bed", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"bed", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"bed", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-5"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"bed", "0.1 %", "cells", {{"Mesh refinement/Criteria", "bed faces"}, {"Mesh refinement/Criteria: bed faces/Cell size at the bottom", "0.5"}, {"Mesh refinement/Criteria: bed faces/Cell size at the top", "0.5"}, {"Mesh refinement/Criteria: bed faces/Half width", "4"}, {"Mesh refinement/Criteria: bed faces/Cell size far away", "8"}, {"Mesh refinement/Interval", "20"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"bed", "0.1 %", "filter", {{"Coupling/Filter radius", "2.5 d"}, {"Coupling/Filter shape", "smooth"}}, "measured with all that is chosen: flux 0.078 %, onset 0.0063 %, heave 0.071 % off; the next looser settings: flux 0.078 %, onset 0.007 %, heave 0.41 %"},
      {"suspension", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: fall 1.9 % off; the next looser settings: fall 3.6 %"},
      {"suspension", "10 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: fall 1.9 % off; the next looser settings: fall 3.6 %"},
      {"suspension", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen: fall 1.9 % off; the next looser settings: fall 3.6 %"},
      {"suspension", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen: fall 1.9 % off; the next looser settings: fall 3.6 %"},
      {"suspension", "10 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "4"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: fall 1.9 % off; the next looser settings: fall 3.6 %"},
      {"suspension", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: fall 0.42 % off; the next looser settings: fall 1.9 %"},
      {"suspension", "1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: fall 0.42 % off; the next looser settings: fall 1.9 %"},
      {"suspension", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen: fall 0.42 % off; the next looser settings: fall 1.9 %"},
      {"suspension", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-3"}}, "measured with all that is chosen: fall 0.42 % off; the next looser settings: fall 1.9 %"},
      {"suspension", "1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: fall 0.42 % off; the next looser settings: fall 1.9 %"},
      {"suspension", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.02"}}, "measured with all that is chosen: fall 0.27 % off; the next looser settings: fall 0.68 %"},
      {"suspension", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: fall 0.27 % off; the next looser settings: fall 0.68 %"},
      {"suspension", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen: fall 0.27 % off; the next looser settings: fall 0.68 %"},
      {"suspension", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-4"}}, "measured with all that is chosen: fall 0.27 % off; the next looser settings: fall 0.68 %"},
      {"suspension", "0.1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "1"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: fall 0.27 % off; the next looser settings: fall 0.68 %"},
      {"other", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: head 5.4 %, grains moved 3.2 % off; these are the loosest that were tried"},
      {"other", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen: head 5.4 %, grains moved 3.2 % off; these are the loosest that were tried"},
      {"other", "10 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.1"}}, "measured with all that is chosen: head 5.4 %, grains moved 3.2 % off; these are the loosest that were tried"},
      {"other", "10 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-2"}}, "measured with all that is chosen: head 5.4 %, grains moved 3.2 % off; these are the loosest that were tried"},
      {"other", "10 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "4"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: head 5.4 %, grains moved 3.2 % off; these are the loosest that were tried"},
      {"other", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-4"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.05"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "4e-5"}, {"Contacts/Largest violation", "0.01"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "0.1 %", "coupling", {{"Coupling/Time scheme: iterated/Tolerance", "0.01"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "0.1 %", "linear solver", {{"Fluid/Linear solver/Tolerance", "1e-4"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"other", "0.1 %", "cells", {{"Mesh refinement/Criteria", "uniform"}, {"Mesh refinement/Criteria: uniform/Cell size", "2"}, {"Mesh refinement/Interval", "0"}}, "measured with all that is chosen: head 0.24 %, grains moved 1.9 % off; the next looser settings: head 0.76 %, grains moved 3 %"},
      {"dry", "10 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "1"}}, "measured with all that is chosen: runout 2.9 %, overlap 6.1 % off; these are the loosest that were tried"},
      {"dry", "10 %", "contacts", {{"Contacts/Residual tolerance", "1e-1"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen: runout 2.9 %, overlap 6.1 % off; these are the loosest that were tried"},
      {"dry", "1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.2"}}, "measured with all that is chosen: runout 1.2 %, overlap 0.26 % off; the next looser settings: runout 2 %, overlap 0.34 %"},
      {"dry", "1 %", "contacts", {{"Contacts/Residual tolerance", "1e-2"}, {"Contacts/Largest violation", "0.5"}}, "measured with all that is chosen: runout 1.2 %, overlap 0.26 % off; the next looser settings: runout 2 %, overlap 0.34 %"},
      {"dry", "0.1 %", "time step", {{"Time/Time step", "auto"}, {"Time/Automatic time step/Tolerance", "0.2"}}, "measured with all that is chosen: runout 1.1 %, overlap 0.075 % off; the next looser settings: runout 1.2 %, overlap 0.26 %"},
      {"dry", "0.1 %", "contacts", {{"Contacts/Residual tolerance", "1e-3"}, {"Contacts/Largest violation", "0.1"}}, "measured with all that is chosen: runout 1.1 %, overlap 0.075 % off; the next looser settings: runout 1.2 %, overlap 0.26 %"},
    };
    // clang-format on
    return table;
  }
} // namespace alluvium::scene
