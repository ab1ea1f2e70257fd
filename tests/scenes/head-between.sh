#!/bin/bash
# A differential head and an onset are reported where they have a meaning: a bed that a flow crosses from bottom to top. Elsewhere the
# head is that between two boundaries that the user names.
. "$SCENES/functions"
scene_from bed <<'END'
subsection Time
  set End time = 0.002
end
END
must_run 1 bed.prm
grep -q differential_head output/statistics.csv && grep -q 'exact_head_m' output/summary.json || fail "a bed from side to side has a head and an onset"

# Flow from left to right through the bed, under a head of 1 mm: none of it is between bottom and top.
across=(--set 'Boundary conditions/Slip walls=top, bottom' --set 'Boundary conditions/Pressure=left: rho*g*(H - y + 1e-3); right: rho*g*(H - y)'
        --set 'Output/Overwrite output folder=true')
must_run 1 bed.prm "${across[@]}"
! grep -q 'differential_head\|onset\|exact_head' output/statistics.csv output/summary.json || fail "there is no such head"
grep -q 'head .*not reported' screen-output || fail "it does not say so"
must_run 1 bed.prm "${across[@]}" --set 'Output/Head between=left, right'
! grep -q 'onset' output/summary.json || fail "there is no such onset"
/usr/bin/python3 - <<'END' || fail "the head between left and right"
import csv
rows = list(csv.DictReader(open("output/statistics.csv")))
# u^2/(2 g) is 1e-8 m at the most
assert abs(float(rows[-1]["differential_head_m"]) - 1e-3) < 1e-6, rows[-1]
END

# Two boundaries at the top, as beside a sheet pile, are none below and above.
must_run 1 --check bed.prm --set 'Boundary conditions/Slip walls=right, bottom' --set 'Boundary conditions/Pressure=left: rho*g*(H - y); top: 0'
grep -q 'head .*not reported' screen-output || fail "a flow from the side to the top has no such head"
