#!/bin/bash
# An output folder that holds a run is not touched unless that is asked for; what somebody else has put there stays.
. "$SCENES/functions"
scene=tiny.prm
scene_from tiny </dev/null

must_run 1 "$scene"
echo mine >output/notes.txt
contents output >before
for ranks in 1 2; do
  must_fail "output folder 'output' holds an older run; .*Overwrite output folder = true" $ranks "$scene"
  contents output | cmp - before || fail "it changed the older run"
done

echo old >output/fluid-00007.vtu
must_run 1 "$scene" --set 'Output/Overwrite output folder=true'
[ -f output/notes.txt ] || fail "it removed a file that is not of a run"
[ ! -f output/fluid-00007.vtu ] || fail "it left a file of the older run"
