#!/bin/bash
# What drives a periodic layer: gravity along it, a mean pressure gradient or a body force do the same; a gradient can hold
# gravity, as the pressure of fluid at rest does elsewhere, and cannot be given where there are boundaries.
# SLOW
. "$SCENES/functions"
scene_from layer <<'END'
END

last() { # COLUMN
  python3 -c 'import csv,sys; print(list(csv.DictReader(open("output/statistics.csv")))[-1][sys.argv[1]])' "$1"
}
must_be() { # VALUE TOLERANCE WHAT
  local speed
  speed=$(last largest_fluid_velocity_m_per_s)
  python3 -c "import sys; sys.exit(not abs($speed - $1) <= $2)" || fail "$3: $speed m/s instead of $1"
}

must_run 1 layer.prm --set 'Gravity=0,-9.8' --set 'Fluid/Mean pressure gradient=-500 | 0'
must_be 0.3125 3e-3 'mean pressure gradient'
must_run 1 layer.prm --set 'Output/Overwrite output folder=true' --set 'Gravity=0,-9.8' --set 'Fluid/Body force=rho*0.5*min(1, t/0.1) | 0'
must_be 0.3125 3e-3 'body force'
must_run 1 layer.prm --set 'Output/Overwrite output folder=true' --set 'Gravity=0.5,-9.8' --set 'Fluid/Mean pressure gradient=rho*0.5 | 0'
must_be 0 1e-12 'gravity held by a pressure gradient'

# without the speck's share the parabola is exact at the nodes, the flux but for the chords between them: 1 - 1/(4 n^2) of it
must_run 1 layer.prm --set 'Output/Overwrite output folder=true' --set 'Gravity=0.5,-9.8' --set 'Time/End time=10' \
  --set 'Fluid/Linear solver/Tolerance=1e-12' --set 'Grains/Fluid radius factor=0.001' --set 'Coupling/Drag law: disc/Factor=0'
must_be 0.3125 1e-7 'exact parabola'
flux=$(last flux_along_x_m2_per_s)
python3 -c "import sys; sys.exit(not abs($flux / (1000 * 0.5 * 0.005**3 / (3 * 0.02) * (1 - 1 / (4 * 20**2))) - 1) <= 1e-6)" ||
  fail "exact parabola: a flux of $flux m^2/s"

must_fail "Mean pressure gradient: y is no periodic direction" 1 layer.prm --set 'Output/Overwrite output folder=true' --set 'Fluid/Mean pressure gradient=0 | 3'
must_fail "Body force: .* several values" 1 layer.prm --set 'Output/Overwrite output folder=true' --set 'Fluid/Body force=0,5 | 0'
