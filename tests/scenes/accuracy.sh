#!/bin/bash
# Accuracy: the error is below what was asked, for the flux through a fixed bed and for the fall of a suspension; --check says what is
# chosen and why, and what the scene has itself wins.
# SLOW
. "$SCENES/functions"
lab="$SCENES/../../doc/lab/accuracy"
small_bed=(--set 'Domain/Upper right corner=0.004,0.006' --set 'Grains/Deposit: settled bed/Number of grains=300')
small_suspension=(--set 'Domain/Upper right corner=0.004,0.008' --set 'Time/End time=0.03')

last() { # COLUMN: its last value, of a settling speed its mean over the run: how far grains have fallen
  python3 - "$1" <<'END'
import csv, sys
rows = list(csv.DictReader(open("output/statistics.csv")))
rows = [row for row in rows if row[sys.argv[1]] != ""]
t, y = ([float(row[name]) for row in rows] for name in ("time_s", sys.argv[1]))
fall = sum((t[i] - t[i - 1]) * (y[i] + y[i - 1]) / 2 for i in range(1, len(t)))
print(fall / t[-1] if sys.argv[1].startswith("settling") else y[-1])
END
}

compare() { # COLUMN SCENE SETTINGS...: with a reference on fine even cells
  local column=$1 scene=$2 settings=("${@:3}" --set 'Output/Overwrite output folder=true' --set 'Output/Interval of pictures=0') reference accuracy
  must_run 1 "$scene" "${settings[@]}" --set 'Mesh refinement/Criteria=uniform' --set 'Mesh refinement/Criteria: uniform/Cell size=0.5' \
    --set 'Coupling/Filter radius=2.5 d' --set 'Coupling/Filter shape=smooth' --set 'Time/Time step=5e-4'
  reference=$(last "$column")
  for accuracy in '10 %' '1 %'; do
    must_run 1 "$scene" "${settings[@]}" --set "Accuracy=$accuracy"
    grep -q "^  accuracy *$accuracy, as measured for: " screen-output || fail "the report does not say the accuracy"
    python3 - "$reference" "$(last "$column")" "$accuracy" <<'END' || fail "$scene is not within $accuracy"
import sys
reference, found, asked = float(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3].split()[0]) / 100
print(reference, found, "error", abs(found / reference - 1), "asked", asked)
assert 0 < abs(found / reference - 1) < asked
END
  done
}

compare flux_top_m2_per_s "$lab/flux.prm" "${small_bed[@]}"
grep -q 'set Tolerance *= 0' output/parameters.prm || fail "parameters.prm does not have what was chosen"
compare settling_speed_m_per_s "$lab/settling.prm" "${small_suspension[@]}"
grep -q 'a suspension: cells are even' screen-output || fail "a suspension"
grep -q 'as measured for: a suspension' output/log.txt || fail "the log does not say what was chosen"

# whatever is chosen is a parameter that there is, and has a value that it may have
for scene in flux settling jet runout; do
  for accuracy in '10 %' '1 %' '0.1 %'; do
    must_run 1 --print-parameters "$lab/$scene.prm" --set "Accuracy=$accuracy"
    grep -q 'set Time step *= auto' screen-output || fail "Accuracy = $accuracy chooses nothing for $scene"
  done
done

# kinds of scenes, reasons, and the scene's own
must_run 1 --check "$lab/flux.prm" "${small_bed[@]}" --set 'Accuracy=1 %' --set 'Fluid/Linear solver/Tolerance=1e-7'
for text in 'a bed whose fluid comes and goes through its two faces' 'measured with all that is chosen: flux .*%.* off' \
  'time step: Time/Time step = auto, Time/Automatic time step/Tolerance = ' 'cells: Mesh refinement/Criteria = bed faces' \
  "linear solver: as the scene has them: Fluid/Linear solver/Tolerance = 1e-7 (--set" '  time step   chosen step by step'; do
  grep -q -- "$text" screen-output || fail "missing: $text"
done
[ "$(grep -c 'measured with all' screen-output)" -eq 1 ] || fail "the reason is said more than once"
must_run 1 --check "$lab/jet.prm" --set 'Accuracy=10 %'
grep -q "fluid enters or leaves by 'slot': cells are even" screen-output || fail "a jet"
must_run 1 --check "$lab/runout.prm" --set 'Accuracy=10 %'
grep -q 'as measured for: dry grains' screen-output || fail "dry grains"
must_fail "'Accuracy' cannot be '5 %': expected .*10 %" 1 --check "$lab/flux.prm" --set 'Accuracy=5 %'
must_run 1 --check "$lab/flux.prm" "${small_bed[@]}"
! grep -q '^  accuracy' screen-output || fail "it speaks of accuracy where it is off"
