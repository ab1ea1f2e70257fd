#!/bin/bash
# Model = auto: what it leaves out of five kinds of scene and what that changes; terms that come on in the run, and a restart after that.
# SLOW
. "$SCENES/functions"
prm=$SCENES/../../prm

# must_be_on 'TERM;TERM' ARGUMENTS...: in the table that --check prints, exactly these are on
must_be_on() {
  must_run 1 --check "${@:2}" --set Model=auto
  /usr/bin/python3 - "$1" <<'END' || fail "terms of ${*:2}"
import re, sys
text = open("screen-output").read()
assert re.search(r"term +\| on or off \| estimate +\| because", text)
rows = re.findall(r"^(?:  model  )? +([a-z][a-z -]*[a-z]) +\| (on|off)[^|]*\|[^|]*\| .+$", text, re.M)
rows = [row for row in rows if row[0] != "term"]
assert len(rows) == 13, rows
expected = sorted(name.strip() for name in sys.argv[1].split(";"))
found = sorted(name for name, state in rows if state == "on")
assert found == expected, (found, expected)
END
}

of_summary() { # FOLDER PATH
  /usr/bin/python3 -c '
import json, sys
node = json.load(open(sys.argv[1] + "/summary.json"))
for name in sys.argv[2].split("/"):
    node = node[name]
print(node)' "$1" "$2"
}

all_of_bed='fluid;convection;inertia of the fluid;viscous stress of the mixture;two-way coupling;iteration of fluid and contacts;contacts;friction;rotation of grains'
must_be_on 'fluid;viscous stress of the mixture;two-way coupling' "$prm/fixed-bed.prm"
must_be_on 'contacts;friction;rotation of grains;sub-steps' "$prm/dry-column-collapse.prm" --set 'Grains/Deposit: settled bed/Number of grains=200'
must_be_on "$all_of_bed;adaptivity;sub-steps" "$prm/fluidised-bed.prm" --set 'Grains/Deposit: settled bed/Number of grains=300' \
  --set 'Domain/Upper right corner=0.004, 0.01'
must_be_on "$all_of_bed;sub-steps" "$prm/gas-fluidised-bed.prm" --set 'Grains/Deposit: settled bed/Number of grains=300'
dilute=("$prm/sedimentation.prm" --set 'Grains/Deposit: random suspension/Area fraction=0.02' --set 'Time/Time step=5e-4'
        --set 'Grains/Deposit: random suspension/Smallest gap=1e-4')
must_be_on 'fluid;convection;inertia of the fluid;viscous stress of the mixture;two-way coupling' "${dilute[@]}"
must_be_on 'fluid;viscous stress of the mixture;two-way coupling' "${dilute[@]}" --set Fluid/Viscosity=1.5 \
  --set 'Output/Interval of statistics=0.2'
# steel in air, low enough: nothing but contacts
steel=("$prm/dry-column-collapse.prm" --set Fluid/Model=volume-averaged --set Fluid/Density=1.2 --set Fluid/Viscosity=1.8e-5
       --set Grains/Density=7800 --set 'Grains/Deposit: settled bed/Smallest diameter=5e-3' --set 'Grains/Deposit: settled bed/Number of grains=40'
       --set 'Grains/Deposit: settled bed/Box=0, 0, 0.05, 0.09' --set 'Domain/Upper right corner=0.2, 0.09'
       --set 'Boundary conditions/No-slip walls=left, right, bottom, top' --set 'Boundary conditions/Pin pressure=true')
must_be_on 'contacts;friction;rotation of grains;sub-steps' "${steel[@]}" --set 'Automatic model/Accuracy=0.5'
grep -q 'fluid .*left out (Model = auto): no mesh' screen-output || fail "steel in air has a mesh"
must_be_on "$all_of_bed;sub-steps;adaptivity" "${steel[@]}" --set 'Automatic model/Accuracy=0.5' --set 'Automatic model/Keep=fluid'

# What is not left out for good: full is the default, and says nothing of it
must_run 1 --check "$prm/fixed-bed.prm"
! grep -q 'on or off' screen-output || fail "a table with Model = full"
must_fail "Model.*full|auto" 1 --check "$prm/fixed-bed.prm" --set Model=some
must_fail "Keep" 1 --check "$prm/fixed-bed.prm" --set 'Automatic model/Keep=gravity'

# A fixed bed: the same flux, and steps that cost nothing
scene_from bed <<'END'
subsection Grains
  set Fixed = true
end
subsection Time
  set End time  = 0.05
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 0.05*rho*g*L
end
subsection Output
  set Interval of statistics = 0.01
end
END
must_run 1 bed.prm --set 'Output/Output folder=full'
must_run 1 bed.prm --set 'Output/Output folder=auto' --set Model=auto
[ "$(of_summary auto 'model/inertia of the fluid/on')" = no ] || fail "a fixed bed at low Reynolds number has inertia"
# each term that is left out may take a thousandth, and there are three
must_agree full/statistics.csv auto/statistics.csv --tolerance 3e-3 --ignore flux_imbalance
/usr/bin/python3 - "$(of_summary full 'counts/linear iterations')" "$(of_summary auto 'counts/linear iterations')" \
  "$(of_summary auto 'counts/fluid steps like the last')" <<'END' || fail "a fixed bed is solved again and again"
import sys
full, auto, steady = map(float, sys.argv[1:])
print("linear iterations", full, auto, "steps like the last", steady)
assert auto < 0.5 * full and steady == 48
END

# Too short for the estimates to see, a jet of water comes: inertia is on from there
pulse=(--set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H + rho*g*L*if(abs(t - 0.025125) < 6e-5, 20, 0.05)' --set 'Time/Time step=5e-5'
       --set 'Time/End time=0.03')
must_run 1 bed.prm --set 'Output/Output folder=pulse' --set Model=auto "${pulse[@]}"
grep -q 't = 0.025[0-9]* s: inertia of the fluid switched on, estimate' screen-output || fail "no word of inertia"
grep -q 'inertia of the fluid switched on' pulse/log.txt || fail "no line in the log"
[ "$(of_summary pulse 'model/inertia of the fluid/on')" = yes ] || fail "the summary does not know of inertia"

# Grains that come near each other: contacts are there in time, and a restart after that gives the same bytes
falling=$SCENES/data/falling.prm
must_run 1 "$falling" --set 'Output/Output folder=fallen' --set Model=full --set 'Output/Digits=17'
must_run 1 "$falling" --set 'Output/Output folder=whole' --set 'Output/Digits=17'
grep -E '^ *(model|[a-z -]+) *\|' screen-output
grep 'switched on' screen-output
grep -q 's: contacts switched on' screen-output || fail "contacts were not switched on"
[ "$(of_summary whole model/contacts/on)" = yes ] && [ "$(of_summary whole model/convection/on)" = no ] || fail "summary of falling grains"
when=$(of_summary whole model/contacts/switched_on_s)
/usr/bin/python3 -c 'import sys; assert 0.5 < float(sys.argv[1]) < 18' "$when" || fail "contacts are on from $when s"
# but for when exactly they meet, which shows in the row of then
must_agree fallen/statistics.csv whole/statistics.csv --tolerance 1e-2 --from 10
for end in 0.5 "$(/usr/bin/python3 -c "print(round($when + 0.5, 3))")"; do
  rm -rf half
  must_run 1 "$falling" --set 'Output/Output folder=half' --set "Time/End time=$end" --set 'Output/Digits=17'
  must_run 1 "$falling" --set 'Output/Output folder=half' --set 'Output/Restart=true' --set 'Output/Digits=17'
  cmp whole/statistics.csv half/statistics.csv || fail "a restart at $end s differs"
  [ "$(of_summary half model/contacts/switched_on_s)" = "$when" ] || fail "the restarted run forgot when contacts came on"
done

# On two ranks terms come on at the same time
must_run 2 "$falling" --set 'Output/Output folder=two' --set 'Output/Digits=17'
[ "$(of_summary two model/contacts/switched_on_s)" = "$when" ] || fail "contacts come on at another time on two ranks"
must_agree whole/statistics.csv two/statistics.csv --tolerance 1e-5
must_run 2 bed.prm --set 'Output/Output folder=bed-on-two' --set Model=auto
must_agree auto/statistics.csv bed-on-two/statistics.csv --tolerance 1e-5 --ignore flux_imbalance
