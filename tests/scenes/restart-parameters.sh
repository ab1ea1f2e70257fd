#!/bin/bash
# A restart refuses changed parameters that it would ignore, by name, and leaves the folder as it was; lists those that it takes; keeps
# the clock when the time step changes; needs no deposit; and says that its end has passed.
# SLOW
. "$SCENES/functions"
scene_from bed <<'END'
subsection Output
  set Interval of checkpoints = 0.004
end
END
must_run 1 bed.prm --set 'Time/End time=0.004'
again=(bed.prm --set Output/Restart=true --set 'Time/End time=0.006')

contents output >before
for change in 'Grains/Density=5000' 'Grains/Fluid packing fraction=0.5' 'Domain/Upper right corner=0.004, 0.007' \
  'Fluid/Model=none' 'Contacts/Contact model=soft-sphere' 'Output/Observers=bed' 'Mesh refinement/Coarsest cell size=4' \
  'Mesh refinement/Margin=1'; do
  must_fail "would be ignored" 1 "${again[@]}" --set "$change"
  grep -qF "${change%%=*}: " error-output || fail "the message does not name ${change%%=*}"
  contents output | cmp - before || fail "it changed the folder of the run"
done
must_fail 'the checkpoint is of t = 0.004 s, and Time/End time = 0.003 s has passed' 1 "${again[@]}" --set 'Time/End time=0.003'
must_fail 'the checkpoint is of t = 0.004 s, and Time/End time = 0.004 s has passed' 1 "${again[@]}" --set 'Time/End time=0.004'
contents output | cmp - before || fail "it changed the folder of the run"

# killed between its last checkpoint and its summary, a run has its summary left to do
cp -r output unconcluded
sed -i 's/"ended": "finished"/"ended": "failed"/; s/"reason": ".*"/"reason": "killed"/' unconcluded/summary.json
must_run 1 bed.prm --set Output/Restart=true --set 'Time/End time=0.004' --set 'Output/Output folder=unconcluded'
cmp output/statistics.csv unconcluded/statistics.csv || fail "the statistics of a run that was ended twice"
/usr/bin/env python3 - <<'END' || fail "the summary of a run that was ended twice"
import json
one, two = (json.load(open(f"{f}/summary.json")) for f in ("output", "unconcluded"))
for s in (one, two):
    s.pop("timing")
differ = {k: (one.get(k), two.get(k)) for k in dict(one, **two) if one.get(k) != two.get(k)}
assert not differ, differ
END

# the clock: 0.0045, 0.005, ... and not that of 4 steps of half the length
cp -r output half && cp -r output double
must_run 1 "${again[@]}" --set 'Output/Output folder=half' --set 'Time/Time step=5e-4'
[ "$(tail -n 4 half/statistics.csv | cut -d, -f1 | tr '\n' ' ')" = '0.0045 0.005 0.0055 0.006 ' ] || fail "the clock of half steps"
grep -q 'changed: Time/Time step: 1e-3 -> 5e-4' screen-output || fail "it does not say that the time step has changed"
must_run 1 "${again[@]}" --set 'Output/Output folder=double' --set 'Time/Time step=2e-3' --set 'Time/End time=0.008'
[ "$(tail -n 2 double/statistics.csv | cut -d, -f1 | tr '\n' ' ')" = '0.006 0.008 ' ] || fail "the clock of double steps"

# the grains come from the checkpoint: what has changed in their file is ignored, and said
cp -r output other-file
rm data && cp -r "$SCENES/data" data && sed -i '3s/,/1,/' data/bed.csv
must_run 1 "${again[@]}" --set 'Output/Output folder=other-file'
grep -q "bed.csv' is not what this run began with" error-output || fail "it does not say that the grains' file has changed"

# the grains come from the checkpoint: their file is not needed any more
rm -r data && mkdir data && cp "$SCENES"/data/bed.prm data
must_run 1 "${again[@]}"
