#!/bin/bash
# A bed at rest that goes on in steps a thousand times as short: what contacts have left of overlaps opens at once, and throws it off its
# floor for some of them. That is no onset.
. "$SCENES/functions"
scene_from bed <<'END'
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 0.9*rho*g*L
end
subsection Contacts
  set Residual tolerance = 1e-3
  set Largest violation  = 1
  set Stagnation tolerance factor = 100
end
subsection Output
  set Interval of statistics = 0
end
END
must_run 1 bed.prm
# energy from overlaps ends a run; here the steps after that are looked at
must_run 1 bed.prm --set 'Time/Time step=1e-6' --set 'Time/End time=0.02004' --set Output/Restart=true --set Divergence/Stop=false
/usr/bin/python3 - <<'END' || fail "an onset of a bed that lies on its floor"
import csv, json
rows = list(csv.DictReader(open("output/statistics.csv")))
floor = [float(r["floor_force_over_weight"]) for r in rows[-40:]]
assert min(floor) < 0.02 and sum(floor) / 40 > 0.2, (min(floor), sum(floor) / 40)
onset = json.load(open("output/summary.json"))["onset by force balance"]
assert list(onset) == ["exact_head_m"], onset
END
