#!/bin/bash
# Through a slot a cell or some wide most of the flow leaves beside its nodes, along faces that end in a wall. The energy balance knows
# what it takes along.
# SLOW
. "$SCENES/functions"
cat >slot.prm <<'END'
set Gravity = 0, 0
subsection Time
  set End time  = 0.5
  set Time step = 1e-3
end
subsection Domain
  set Upper right corner = 0.01, 0.01
  set Named parts        = outlet = top: 0.00469 < x < 0.00531
end
subsection Mesh refinement
  set Criteria = uniform
  set Interval = 0
  subsection Criteria: uniform
    set Cell size = 0.4
  end
end
subsection Boundary conditions
  set Slip walls    = left, right
  set No-slip walls = top
  set Velocity      = bottom: 0 | 0.02
  set Pressure      = outlet: 0
end
subsection Grains
  set Deposit = none
end
subsection Output
  set Observers            = bed, flux, energy
  set Interval of pictures = 0
end
END
run() { # LEAST MOST ARGUMENTS...: of the unexplained power over the work at boundaries
  must_run 1 slot.prm --set 'Output/Overwrite output folder=true' "${@:3}"
  /usr/bin/python3 - "$1" "$2" <<'END' || fail "${*:3}"
import csv, sys
row = list(csv.DictReader(open("output/statistics.csv")))[-1]
work, unexplained = float(row["power_boundaries_W_per_m"]), float(row["power_unexplained_W_per_m"])
print(unexplained / work)
assert float(sys.argv[1]) <= unexplained / work <= float(sys.argv[2]), (unexplained, work)
END
}
run -1e-6 1e-6 --set Fluid/Convection=false
run -0.2 -0.1 # -0.29 without what leaves beside the slot
run -0.25 -0.1 --set 'Mesh refinement/Criteria: uniform/Cell size=0.25'
