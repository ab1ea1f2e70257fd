#!/bin/bash
# Ranks that share the contacts of a moving dry bed print what one rank alone does, to all 15 digits, force chains included; also where a
# checkpoint of one rank is continued on others.
# SLOW
. "$SCENES/functions"

echo $'subsection Fluid\n set Model = none\nend\nset Gravity = 5, -8' | scene_from bed
common=(--set 'Output/Digits=15' --set 'Time/End time=0.008' --set 'Contacts/Least grains a rank=1' --set 'Output/Observers=motion, support, stress'
        --set 'Output/Observers: stress/Interval of force chains=0.002' --set 'Output/Interval of checkpoints=0.004')

must_run 1 bed.prm "${common[@]}" --set 'Output/Output folder=alone'
grep -q 'contacts .*on one rank' screen-output || fail "expected the start-up summary to say who works"
must_run 2 bed.prm "${common[@]}" --set 'Output/Output folder=together'
grep -q 'contacts .*shared by 2 ranks' screen-output || fail "expected the ranks to share"
cmp alone/statistics.csv together/statistics.csv || fail "two ranks differ from one"
for chains in alone/force-chains-*.vtp; do
  cmp "$chains" "together/${chains#alone/}" || fail "two ranks have other forces"
done
[ "$(ls alone/force-chains-*.vtp | wc -l)" -ge 3 ] || fail "expected force chains to compare"

must_run 2 bed.prm "${common[@]}" --set 'Output/Output folder=half' --set 'Time/End time=0.004'
must_run 3 bed.prm "${common[@]}" --set 'Output/Output folder=half' --set 'Output/Restart=true'
cmp alone/statistics.csv half/statistics.csv || fail "a checkpoint of two ranks, continued on three, differs from one rank's run"

must_run 2 bed.prm "${common[@]}" --set 'Output/Output folder=few' --set 'Contacts/Least grains a rank=100000'
grep -q 'contacts .*not shared, all 2 ranks do the same: too few grains' screen-output || fail "expected the reason"
