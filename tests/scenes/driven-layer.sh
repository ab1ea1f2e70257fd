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

# without boundaries nothing holds the fluid: u = g t, and nothing is wrong with that
cat >box.prm <<'END'
set Gravity = 9.81, 0
subsection Time
  set End time  = 0.1
  set Time step = 1e-3
end
subsection Domain
  set Upper right corner  = 0.01, 0.01
  set Periodic directions = x, y
  set Coarse cell size    = 1e-3
end
subsection Boundary conditions
  set Pin pressure = true
end
subsection Grains
  set Deposit = none
end
subsection Output
  set Interval of pictures    = 0
  set Overwrite output folder = true
end
END
for viscosity in 1e-3 10; do
  must_run 1 box.prm --set "Fluid/Viscosity=$viscosity"
  must_be 0.981 1e-7 'free fall'
  [ ! -s error-output ] || fail "a warning without a reason"
done
# nor is there a pressure between a lid that moves and a floor; in the end all terms but friction vanish
must_run 1 box.prm --set Gravity=0,0 --set 'Domain/Periodic directions=x' --set 'Time/End time=1' --set 'Time/Time step=1e-2' \
  --set 'Fluid/Viscosity=1' --set 'Boundary conditions/No-slip walls=bottom' --set 'Boundary conditions/Velocity=top: 0.1 | 0'
must_be 0.1 1e-7 'Couette flow'
[ ! -s error-output ] || fail "a warning without a reason"
