#!/bin/bash
# The mesh changes under a flow that starts from rest, around a grain that sinks: the flow goes on as without that, whatever the time step.
. "$SCENES/functions"

printf 'x,y,radius,density\n0.0193,0.0016,0.00156,3180\n' >grain.csv
cat >scene.prm <<'EOF'
set Gravity = -3.014, -9.3355
subsection Domain
  set Lower left corner  = 0, 0
  set Upper right corner = 0.028, 0.03
end
subsection Fluid
  set Density   = 1000
  set Viscosity = 0.01
end
subsection Grains
  set Deposit = file
  subsection Deposit: file
    set File = grain.csv
  end
end
subsection Boundary conditions
  set No-slip walls = right, bottom
  set Slip walls    = left
  set Pressure      = top: 0
end
subsection Mesh refinement
  set Criteria           = moving grains
  set Interval           = 3
  set Coarsest cell size = 4
  set Finest cell size   = 0.5
  subsection Criteria: moving grains
    set Cell size = 1
  end
end
subsection Time
  set End time = 0.01
end
subsection Output
  set Interval of statistics = 0
  set Interval of pictures   = 0
end
EOF

for dt in 1e-3 2e-4; do
  for interval in 3 0; do
    must_run 1 scene.prm --set "Time/Time step=$dt" --set "Mesh refinement/Interval=$interval" --set "Output/Output folder=$interval-$dt"
  done
  grep -q '"mesh adaptations"' "3-$dt/summary.json" || fail "the mesh has not changed"
  python3 - "3-$dt" "0-$dt" <<'EOF' || fail "the flow is another one after the mesh has changed"
import csv, sys
changed, kept = ([float(row["largest_fluid_velocity_m_per_s"]) for row in csv.DictReader(open(f"{folder}/statistics.csv"))] for folder in sys.argv[1:])
ratio = max(a / b for a, b in zip(changed[1:], kept[1:]))
print("largest velocity, over that on a mesh that stays:", ratio)
sys.exit(not ratio < 2)
EOF
done
