#!/bin/bash
# Without a grain: plane Poiseuille flow, exact at the nodes; on triangles of a mesh file, with cells that follow the flow, on ranks,
# over a restart. No grains by mistake is another matter.
# SLOW
. "$SCENES/functions"
cat >channel.prm <<'END'
subsection Time
  set End time  = 600
  set Time step = 100
end
subsection Domain
  set Upper right corner  = 0.004, 0.008
  set Periodic directions = x
end
subsection Mesh refinement
  set Criteria = uniform
  set Interval = 0
  subsection Criteria: uniform
    set Cell size = 1
  end
end
subsection Fluid
  set Mean pressure gradient = -0.1 | 0
  subsection Linear solver
    set Tolerance = 1e-12
  end
end
subsection Boundary conditions
  set No-slip walls = bottom, top
  set Pin pressure  = true
end
subsection Grains
  set Deposit = none
end
subsection Output
  set Interval of statistics = 0
  set Interval of pictures   = 100
  set Digits                 = 15
end
END
column() {
  /usr/bin/python3 -c 'import csv, sys; print(list(csv.DictReader(open(sys.argv[1] + "/statistics.csv")))[-1][sys.argv[2]])' "$1" "$2"
}
near() { # A B RELATIVE WHAT
  /usr/bin/python3 -c 'import sys; a, b, e = map(float, sys.argv[1:4]); sys.exit(not abs(a - b) <= e * abs(b))' "$@" || fail "$4: $1 is not $2"
}
# u = G y (H - y) / (2 eta) at the nodes; the flux is that of the chords between them, 1 - (h/H)^2 of G H^3 / (12 eta)
for ranks in 1 2; do
  must_run $ranks channel.prm --set "Output/Output folder=out-$ranks"
  near "$(column out-$ranks largest_fluid_velocity_m_per_s)" 8e-4 1e-6 "the largest velocity"
  near "$(column out-$ranks flux_along_x_m2_per_s)" "$(/usr/bin/python3 -c 'print(0.1 * 0.008**3 / 12e-3 * (1 - 1 / 64))')" 1e-6 "the flux"
  near "$(column out-$ranks largest_void_fraction)" 1 0 "the void fraction"
done
grep -q '^  grains .*none; sizes in grain diameters are in units of 0.001 m' screen-output || fail "the report says nothing of no grains"
ls out-1/fluid-*.vtu >/dev/null || fail "no pictures"
must_run 1 channel.prm --set 'Output/Output folder=half' --set 'Time/End time=300'
must_run 1 channel.prm --set 'Output/Output folder=half' --set Output/Restart=true
cmp out-1/statistics.csv half/statistics.csv || fail "a restart differs"

# other units, other criteria, a mesh that changes, steps that are chosen
must_run 1 channel.prm --set 'Grains/Deposit: none/Unit of length=5e-4' --set 'Output/Output folder=fine'
near "$(column fine flux_along_x_m2_per_s)" "$(/usr/bin/python3 -c 'print(0.1 * 0.008**3 / 12e-3 * (1 - 1 / 256))')" 1e-6 "the flux in cells of half the size"
must_run 1 channel.prm --set 'Mesh refinement/Criteria=bed faces, velocity jump, void fraction, moving grains, drag work' --set 'Mesh refinement/Interval=1' \
  --set 'Gravity=0, 0' --set 'Output/Output folder=criteria' --set 'Domain/Periodic directions=' --set 'Fluid/Mean pressure gradient=0 | 0' --set 'Boundary conditions/Pin pressure=false' \
  --set 'Boundary conditions/Pressure=left: 4e-4; right: 0'
must_run 1 channel.prm --set 'Time/Time step=auto' --set 'Output/Output folder=auto'
near "$(column auto largest_fluid_velocity_m_per_s)" 8e-4 0.02 "the largest velocity, in steps that are chosen"
must_run 1 --check "$SCENES/bed-on-triangles.prm" --set 'Grains/Deposit=none' --set 'Boundary conditions/Pressure=top: 0; bottom: 100'

# still water is no run-away
must_run 1 channel.prm --set 'Fluid/Mean pressure gradient=0 | 0' --set 'Gravity=0, -9.81' --set 'Output/Output folder=still'
near "$(column still largest_fluid_velocity_m_per_s)" 0 0 "still water"

must_fail 'Deposit = none and Fluid/Model = none: there is nothing to compute' 1 channel.prm --set 'Fluid/Model=none' --set 'Output/Output folder=no'
printf 'x,y,radius\n' >no.csv
must_fail 'no grains' 1 channel.prm --set 'Grains/Deposit=file' --set 'Grains/Deposit: file/File=no.csv' --set 'Output/Output folder=no'
