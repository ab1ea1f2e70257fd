#!/bin/bash
# Grains fall through a domain that is periodic along gravity, at the end by most of a period in a step: the weight's work is all of their
# energy, and nothing else is.
. "$SCENES/functions"

cat >fall.prm <<'SCENE'
set Gravity = 0, -9.81
subsection Time
  set End time  = 0.9
  set Time step = 1e-3
end
subsection Domain
  set Upper right corner  = 0.01, 0.01
  set Periodic directions = x, y
end
subsection Fluid
  set Model = none
end
subsection Grains
  set Deposit = lattice
  subsection Deposit: lattice
    set Diameter      = 1e-3
    set Area fraction = 0.2
  end
end
subsection Output
  set Interval of statistics = 0.1
  set Observers              = motion, bed
end
SCENE
must_run 1 fall.prm
/usr/bin/python3 - <<'CHECK' || fail "it is no free fall"
import csv, json
last = list(csv.DictReader(open("output/statistics.csv")))[-1]
speed = float(last["largest_grain_velocity_m_per_s"])
assert abs(speed / (9.81 * 0.9) - 1) < 1e-9, speed
share = json.load(open("output/summary.json"))["audit"]["largest_unexplained_energy_over_bound"]
print("speed %g m/s, unexplained energy %g of what ends a run" % (speed, share))
assert share < 0.1, share
CHECK
