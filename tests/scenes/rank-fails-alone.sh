#!/bin/bash
# One of two ranks has an error that the other does not know of and waits for it: the run ends all the same, says on which rank it was,
# and leaves its summary and a checkpoint to go on from.
# SLOW
. "$SCENES/functions"
scene_from bed <<END
set Additional shared libraries = $TEST_PLUGINS
subsection Time
  set End time = 0.2
end
subsection Output
  set Interval of checkpoints = 0.002
end
END
for rank in 0 1; do
  rm -rf output
  timeout 100 mpirun -np 2 "$ALLUVIUM" bed.prm --set 'Coupling/Drag law=linear' --set "Coupling/Drag law: linear/Failing rank=$rank" \
    --set 'Coupling/Drag law: linear/Resistance=2e7' --set 'Coupling/Drag law: linear/Calls until then=100000' \
    >screen-output 2>error-output </dev/null
  code=$?
  [ $code -eq 2 ] || fail "exit code $code in place of 2"
  grep -q "This law has failed" error-output || fail "the error is not printed"
  "$SCENES/check-summary" output/summary.json <<<$'ended = ^failed$\nreason = This law has failed' || fail "summary.json"
  [ "$(wc -l <output/statistics.csv)" -gt 2 ] || fail "no statistics"
  [ -d output/checkpoint ] || fail "no checkpoint"
done
must_run 2 bed.prm --set 'Coupling/Drag law=linear' --set 'Coupling/Drag law: linear/Resistance=2e7' --set 'Output/Restart=true'
"$SCENES/check-summary" output/summary.json <<<$'ended = ^finished$' || fail "the run that goes on from there"
