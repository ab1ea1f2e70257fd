#!/bin/bash
# A pressure whose slope changes at the time of a row: the two times differ by round-off, and what lies between them is no step.
. "$SCENES/functions"
scene_from tiny <<'END'
subsection Time
  set Time step = auto
  subsection Automatic time step
    set Largest time step = 0.001
  end
end
subsection Boundary conditions
  set No-slip walls = left, right
  set Pressure      = top: 103e3; bottom: 103e3 + rho*g*H*(1 + min(20*t, 0.22 + (t - 0.011)))
end
subsection Output
  set Interval of statistics  = 0.001
  set Overwrite output folder = true
end
END
for end in 0.17 0.23 0.3; do
  must_run 1 tiny.prm --set "Time/End time=$end"
  python3 - <<'END' || fail "a step between a row and a kink, in a run of $end s"
import csv, json
shortest = json.load(open("output/summary.json"))["time step"]["shortest_s"]
times = [float(row["time_s"]) for row in csv.DictReader(open("output/statistics.csv"))]
assert shortest > 1e-5, shortest
assert any(abs(t - 0.011) < 1e-12 for t in times), times
END
done
