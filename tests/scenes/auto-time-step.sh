#!/bin/bash
# Time step = auto: the error follows the tolerance over three decades, beside a reference in short steps; steps end where rows are due
# and where a given function jumps; a step that is too long is taken back; a fixed step has no such columns; a word is refused.
# SLOW
. "$SCENES/functions"
scene_from layer <<'END'
subsection Time
  set Time step = auto
  set End time  = 2
end
subsection Output
  set Overwrite output folder = true
end
END
swings=(--set 'Fluid/Body force=rho*0.5*sin(3*t) | 0' --set 'Output/Digits=12')

last() { # COLUMN
  python3 -c 'import csv,sys; print(list(csv.DictReader(open("output/statistics.csv")))[-1][sys.argv[1]])' "$1"
}
speed() { last largest_fluid_velocity_m_per_s; }

must_run 1 layer.prm "${swings[@]}" --set 'Time/Time step=5e-4'
! grep -q time_step output/statistics.csv || fail "columns of chosen steps in a run with a fixed one"
reference=$(speed)
found=
for tolerance in 1e-1 1e-2 1e-3 1e-4; do
  must_run 1 layer.prm "${swings[@]}" --set "Time/Automatic time step/Tolerance=$tolerance" --set 'Time/Automatic time step/Largest time step=1'
  found+="$tolerance $(speed) $(grep -o '"steps": [0-9]*' output/summary.json | head -1 | cut -d' ' -f2);"
done
echo "reference $reference; $found"
python3 - "$reference" "$found" <<'END' || fail "the error does not follow the tolerance"
import math, sys
reference, rows = float(sys.argv[1]), [row.split() for row in sys.argv[2].split(";") if row.strip()]
errors = [abs(float(speed) / reference - 1) for _, speed, _ in rows]
steps = [int(n) for *_, n in rows]
for (tolerance, *_), error, n in zip(rows, errors, steps):
    print(tolerance, "%.2e" % error, n)
# a first-order scheme: the error of all steps goes with their length, the root of the error of one
assert all(error < math.sqrt(float(tolerance)) for (tolerance, *_), error in zip(rows, errors))
assert all(1.8 < a / b < 6 for a, b in zip(errors, errors[1:])), errors
assert all(2 < b / a < 5 for a, b in zip(steps, steps[1:])), steps
END

# a jump: a step ends just before it, the next one starts anew
must_run 1 layer.prm --set 'Fluid/Body force=rho*if(t < 0.7123, 0.1, 0.5) | 0' --set 'Output/Interval of statistics=0' --set 'Output/Digits=12'
grep -q '^0.7123,' output/statistics.csv || fail "no step ends at the jump"
python3 - <<'END' || fail "steps around the jump"
import csv
rows = list(csv.DictReader(open("output/statistics.csv")))
after = next(row for row in rows if float(row["time_s"]) > 0.71231)
assert after["time_step_limit"] == "start" and float(after["time_step_s"]) < 0.01, after
assert {"growth", "fluid"} <= {row["time_step_limit"] for row in rows}
END

# a jump that nothing tells of: the step is taken back, and time goes on without a gap
must_run 1 layer.prm --set 'Fluid/Body force=rho*if(sin(2*floor(250*t)) > 0.9, 0.5, 0.1) | 0' --set 'Output/Interval of statistics=0' \
  --set 'Time/Automatic time step/Tolerance=1e-3'
python3 - <<'END' || fail "steps that were taken back"
import csv
rows = list(csv.DictReader(open("output/statistics.csv")))
assert int(rows[-1]["time_steps_taken_back"]) > 0 and float(rows[-1]["time_s"]) == 2
for a, b in zip(rows, rows[1:]):
    assert abs(float(b["time_s"]) - float(a["time_s"]) - float(b["time_step_s"])) < 1e-8
END

# rows are met exactly; the explicit scheme's limit holds and stands beside
must_run 1 layer.prm "${swings[@]}" --set 'Output/Interval of statistics=0.3'
[ "$(cut -d, -f1 output/statistics.csv | tr '\n' ' ')" = 'time_s 0 0.3 0.6 0.9 1.2 1.5 1.8 ' ] || fail "rows are not where they are due"

must_fail "Time step: expected .auto. or a number" 1 layer.prm --set 'Time/Time step=automatic'
must_fail "Time step: expected .auto. or a number" 1 layer.prm --set 'Time/Time step=1e-3 s'
must_fail "Time step: expected .auto. or a number" 1 layer.prm --set 'Time/Time step=0'
must_fail "Smallest time step: .* is above the largest" 1 layer.prm --set 'Time/Automatic time step/Smallest time step=1' \
  --set 'Time/Automatic time step/Largest time step=0.1'
