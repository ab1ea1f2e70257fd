#!/bin/bash
# A bed at rest whose moments are corrected, between walls and periodic, with rolling friction: the same to all 15 digits on two ranks, and
# after a restart on another number of them. Walls carry the weight, and the smooth velocity is below its tolerance.
# SLOW
. "$SCENES/functions"

for sides in walls periodic; do
  [ $sides = walls ] && { periodic= width=0.008; } || { periodic='set Periodic directions = x' width=0.008; }
  cat >$sides.prm <<END
subsection Time
  set Time step = 1e-3
  set End time  = 0.03
end
subsection Domain
  set Upper right corner = $width, 0.02
  $periodic
end
subsection Fluid
  set Model = none
end
subsection Grains
  set Fluid packing fraction = 0
  subsection Deposit: settled bed
    set Number of grains  = 1500
    set Smallest diameter = 0.2e-3
    set Cache folder      =
  end
end
subsection Contacts
  set Rolling friction coefficient = 0.05
  set Least grains a rank          = 1
  set Steps to rest                = 0
end
subsection Output
  set Digits                  = 15
  set Interval of pictures    = 0
  set Interval of statistics  = 0
  set Interval of checkpoints = 0.015
  set Observers               = motion, support, audit
end
END
  must_run 1 $sides.prm --set "Output/Output folder=$sides-alone"
  must_run 2 $sides.prm --set "Output/Output folder=$sides-together"
  grep -q 'contacts .*shared by 2 ranks' screen-output || fail "expected the ranks to share"
  cmp $sides-alone/statistics.csv $sides-together/statistics.csv || fail "two ranks differ from one"
  must_run 2 $sides.prm --set "Output/Output folder=$sides-half" --set 'Time/End time=0.015'
  must_run 1 $sides.prm --set "Output/Output folder=$sides-half" --set 'Output/Restart=true'
  cmp $sides-alone/statistics.csv $sides-half/statistics.csv || fail "a run that was continued differs from one in one go"
  /usr/bin/python3 - $sides-alone $sides-half <<'END' || fail "the bed is not held"
import csv, json, sys

alone, half = (json.load(open(f"{folder}/summary.json")) for folder in sys.argv[1:])
n = alone["counts"]["contact solves' corrections of moments"]
last = list(csv.DictReader(open(sys.argv[1] + "/statistics.csv")))[-1]
print(n, last["wall_force_over_weight"], last["contact_smooth_velocity_over_g_dt"])
assert n > 0, "nothing was corrected"
assert half["counts"]["contact solves' corrections of moments"] == n
assert abs(float(last["wall_force_over_weight"]) - 1) < 2e-3
assert float(last["contact_smooth_velocity_over_g_dt"]) <= 1e-3
END
done
