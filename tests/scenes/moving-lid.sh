#!/bin/bash
# A boundary that moves along itself works on the fluid: where viscosity reaches less than a cell in a step, most of that work gives its
# layer of cells their momentum, and is no divergence. In the end the flow is Couette's, and the lid's power eta U^2 / H; over a floor with a
# slip length l it is eta U^2 / (H + l), of which the floor's friction takes l / (H + l).
# SLOW
. "$SCENES/functions"
ln -s "$SCENES/data/cavity.prm" .
n=0
for change in "Time/Time step=1e-3" "Time/Time step=1e-4" "Time/Time step=1e-2" "Boundary conditions/Velocity=top: 1 | 0" \
  "Boundary conditions/Velocity=top: 0.1*min(1, t/0.01) | 0" "Boundary conditions/Velocity=top: 0.1*sin(300*t) | 0" "Gravity=0, -9.81"; do
  must_run 1 cavity.prm --set "$change" --set "Output/Output folder=out-$((++n))"
done
couette=(--set "Domain/Periodic directions=x" --set "Boundary conditions/No-slip walls=bottom" --set "Fluid/Viscosity=0.1" --set "Time/End time=3"
  --set "Time/Time step=2e-2")
for ranks in 1 2; do
  must_run $ranks cavity.prm "${couette[@]}" --set "Output/Output folder=couette-$ranks"
  /usr/bin/python3 - couette-$ranks <<'END_OF_CHECK' || fail "couette-$ranks"
import csv, sys
last = list(csv.DictReader(open(sys.argv[1] + "/statistics.csv")))[-1]
speed, viscosity, width = 0.1, 0.1, 0.01  # as wide as it is high
power = viscosity * speed**2 / width * width
assert abs(float(last["power_boundaries_W_per_m"]) / power - 1) < 1e-4, (last["power_boundaries_W_per_m"], power)
assert abs(float(last["largest_fluid_velocity_m_per_s"]) / speed - 1) < 1e-6, last
assert abs(float(last["power_unexplained_W_per_m"])) < 1e-6 * power, last
END_OF_CHECK
done

slip_length=("${couette[@]}" --set "Boundary conditions/No-slip walls=" --set "Boundary conditions/Navier slip=bottom: H/2")
must_run 1 cavity.prm --check "${slip_length[@]}"
grep -q "bottom: slip length H/2, a wall" screen-output || fail "the report does not say what the floor is"
must_run 1 cavity.prm "${slip_length[@]}" --set "Output/Output folder=slip-length"
/usr/bin/python3 - <<'END_OF_CHECK' || fail "slip-length"
import csv
last = list(csv.DictReader(open("slip-length/statistics.csv")))[-1]
speed, viscosity, width, slip_length = 0.1, 0.1, 0.01, 0.005
power = viscosity * speed**2 / (width + slip_length) * width
friction = power * slip_length / (width + slip_length)
assert abs(float(last["power_boundaries_W_per_m"]) / power - 1) < 1e-4, (last["power_boundaries_W_per_m"], power)
assert abs(float(last["power_open_boundaries_W_per_m"]) / -friction - 1) < 1e-4, (last["power_open_boundaries_W_per_m"], friction)
assert abs(float(last["power_unexplained_W_per_m"])) < 1e-6 * power, last
END_OF_CHECK
